// Doors (lining, casing, leaf) and windows (reveal, frame, pane, sill, radiator, curtain).
#include <cmath>
#include <numbers>

#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

constexpr double casing_width_m = 0.07, casing_depth_m = 0.018, leaf_depth_m = 0.04;
constexpr double niche_depth_m = 0.16, pane_depth_m = 0.12;
const Material white_wood{"lacquer", 3, {206, 202, 194}};

// x along the wall from its p0, y into the room, z from the room's floor.
Stand stand_at(const WallGeometry& wall) { return {{wall.p0.x(), wall.p0.y(), wall.z_floor}, wall.along}; }

// The four (or three) faces that line a hole from y = 0 back to y = -depth.
void add_reveal(SceneAssembly& builder, const Tag& tag, const Stand& stand, const Opening& o, double depth,
                const Material& sides, const Material& sill, const Tag& sill_tag) {
  const Eigen::Vector3d x = stand.direction(Eigen::Vector3d::UnitX()),
                        y = stand.direction(Eigen::Vector3d::UnitY());
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double w = o.along_max - o.along_min, h = o.z_max - o.z_min;
  builder.add_rectangle(tag, stand.at({o.along_min, -depth, o.z_min}), y, z, {depth, h}, sides);
  builder.add_rectangle(tag, stand.at({o.along_max, 0, o.z_min}), -y, z, {depth, h}, sides);
  builder.add_rectangle(tag, stand.at({o.along_min, 0, o.z_max}), x, -y, {w, depth}, sides);
  builder.add_rectangle(sill_tag, stand.at({o.along_min, -depth, o.z_min}), x, y, {w, depth}, sill);
}

void add_casing(SceneAssembly& builder, const Tag& tag, const WallGeometry& wall, const Opening& o) {
  const Stand stand = stand_at(wall);
  const double c = casing_width_m, d = casing_depth_m;
  const unsigned sides = all_sides & ~BoxSide::back;
  Tag own = tag;
  own.room = wall.room;
  builder.add_box(own, stand, {o.along_min - c, 0, o.z_min}, {o.along_min, d, o.z_max + c}, white_wood,
                  sides);
  builder.add_box(own, stand, {o.along_max, 0, o.z_min}, {o.along_max + c, d, o.z_max + c}, white_wood,
                  sides);
  builder.add_box(own, stand, {o.along_min, 0, o.z_max}, {o.along_max, d, o.z_max + c}, white_wood, sides);
}

void add_leaf(SceneAssembly& builder, const DoorLeafPlan& plan, DoorGeometry& door, int index) {
  const bool first = builder.plan().rooms[static_cast<std::size_t>(door.rooms[0])].id == plan.room;
  const WallGeometry& wall = builder.scene().walls[static_cast<std::size_t>(door.walls[first ? 0 : 1])];
  const Tag tag{SceneClass::door, builder.add_instance(SceneClass::door, -1, "leaf", -1, index).instance,
                wall.room};
  door.leaf_instance = tag.instance;
  // Facing the wall, right is against `along` (the wall runs counter-clockwise).
  const double side = plan.hinge == "left" ? 1.0 : -1.0;
  const Eigen::Vector2d face = door.center + 0.5 * door.thickness * (first ? 1.0 : -1.0) * door.normal;
  const Eigen::Vector2d hinge = face + side * 0.5 * door.width * wall.along;
  const double angle = plan.angle_deg * std::numbers::pi / 180;
  const Eigen::Vector2d reach = -side * std::cos(angle) * wall.along + std::sin(angle) * wall.normal;
  const double width = door.width - 0.03, height = door.height - 0.02, half = 0.5 * leaf_depth_m;
  const Eigen::Vector2d middle = hinge + 0.5 * width * reach + (half + casing_depth_m) * wall.normal;
  const Stand stand{{middle.x(), middle.y(), door.z + 0.01}, reach};
  const Material panel{"door_leaf", builder.plan().seed, {196, 188, 176}};
  const unsigned rim = BoxSide::left | BoxSide::right | BoxSide::top | BoxSide::bottom;
  const Eigen::Vector3d low(-0.5 * width, -half, 0), high(0.5 * width, half, height);
  builder.add_box(tag, stand, low, high, white_wood, rim);
  builder.add_box(tag, stand, low, high, panel, BoxSide::front | BoxSide::back);
  const Material handle{"lacquer", 5, {86, 88, 94}};
  for (const double y : {-half - 0.05, half}) {
    builder.add_box(tag, stand, {0.5 * width - 0.11, y, 0.9}, {0.5 * width - 0.07, y + 0.05, 1.1}, handle);
  }
  builder.scene().solids.push_back({middle,
                                    {0.5 * width, half},
                                    std::atan2(reach.y(), reach.x()),
                                    door.z,
                                    door.z + height,
                                    "doors[" + std::to_string(index) + "] (leaf)"});
}

void add_door(SceneAssembly& builder, std::size_t index) {
  Scene& scene = builder.scene();
  const auto number = static_cast<int>(index);
  const Tag tag = builder.add_instance(SceneClass::door, -1, "", -1, number);
  DoorGeometry& door = scene.doors[index];
  door.instance = tag.instance;
  const WallGeometry wall = scene.walls[static_cast<std::size_t>(door.walls[0])];
  const auto opening_of = [&](const WallGeometry& w) {
    const double along = (door.center - w.p0).dot(w.along), z = door.z - w.z_floor;
    return Opening{along - 0.5 * door.width, along + 0.5 * door.width, z, z + door.height};
  };
  if (door.thickness > 1e-3) {
    // What is walked on in the doorway belongs to the first room's ground where that is level with it.
    Tag ground = tag;
    const auto r = static_cast<std::size_t>(
        std::abs(scene.plan.rooms[static_cast<std::size_t>(door.rooms[0])].z_floor - door.z) < 1e-6
            ? door.rooms[0]
            : door.rooms[1]);
    ground.label = SceneClass::floor, ground.instance = scene.rooms[r].floor_instance;
    add_reveal(builder, tag, stand_at(wall), opening_of(wall), door.thickness, white_wood,
               {"wood", 2, {120, 84, 56}}, ground);
  }
  for (const int w : door.walls) {
    const WallGeometry side = scene.walls[static_cast<std::size_t>(w)];
    add_casing(builder, tag, side, opening_of(side));
  }
  const auto& leaf = scene.plan.doors[index].leaf;
  if (!leaf) return;
  if (leaf->turns.empty() && leaf->set_back == 0 && !leaf->pair)
    add_leaf(builder, *leaf, scene.doors[index], number);
  else
    add_turning_leaf(builder, *leaf, scene.doors[index], number);
}

void add_window_frame(SceneAssembly& builder, const Tag& tag, const Stand& stand, const Opening& o) {
  const double w = 0.055, y0 = -pane_depth_m, y1 = -pane_depth_m + 0.05,
               mid = 0.5 * (o.along_min + o.along_max);
  const unsigned sides = all_sides & ~BoxSide::back;
  builder.add_box(tag, stand, {o.along_min, y0, o.z_min}, {o.along_min + w, y1, o.z_max}, white_wood, sides);
  builder.add_box(tag, stand, {o.along_max - w, y0, o.z_min}, {o.along_max, y1, o.z_max}, white_wood, sides);
  builder.add_box(tag, stand, {mid - 0.5 * w, y0, o.z_min}, {mid + 0.5 * w, y1, o.z_max}, white_wood, sides);
  builder.add_box(tag, stand, {o.along_min, y0, o.z_min}, {o.along_max, y1, o.z_min + w}, white_wood, sides);
  builder.add_box(tag, stand, {o.along_min, y0, o.z_max - w}, {o.along_max, y1, o.z_max}, white_wood, sides);
  builder.add_box(tag, stand, {o.along_min - 0.08, 0, o.z_min - 0.04}, {o.along_max + 0.08, 0.14, o.z_min},
                  white_wood, sides);
}

void add_radiator(SceneAssembly& builder, const WindowPlan& plan, int room, const Stand& stand) {
  const Tag tag = builder.add_instance(SceneClass::radiator, room);
  const double half = 0.4 * plan.width;
  const Eigen::Vector3d low(plan.along - half, 0.04, 0.12), high(plan.along + half, 0.14, plan.sill - 0.12);
  builder.add_box(tag, stand, low, high, {"lacquer", 3, {200, 198, 190}}, all_sides & ~BoxSide::back,
                  Material{"ribs", 3, {200, 198, 190}});
}

void add_curtain(SceneAssembly& builder, const WindowPlan& plan, int room, const WallGeometry& wall,
                 const Stand& stand) {
  const Tag tag = builder.add_instance(SceneClass::curtain, room);
  const double top = std::min(wall.height - 0.05, plan.sill + plan.height + 0.2);
  Rng rng(plan.seed, "curtain", 0);
  const Rgb cloth{static_cast<std::uint8_t>(40 + rng.index(70)),
                  static_cast<std::uint8_t>(50 + rng.index(70)),
                  static_cast<std::uint8_t>(70 + rng.index(90))};
  for (int i = 0; i < 4; ++i) {
    const double a = plan.along + 0.5 * plan.width - 0.02 + 0.09 * i, y = i % 2 ? 0.06 : 0.09;
    if (a + 0.09 > wall.length - 0.02) break;
    builder.add_box(tag, stand, {a, y, 0.06}, {a + 0.09, y + 0.06, top}, {"curtain", 4, cloth});
  }
}

void add_window(SceneAssembly& builder, std::size_t index) {
  Scene& scene = builder.scene();
  const WindowPlan plan = scene.plan.windows[index];
  WindowGeometry& window = scene.windows[index];
  const int r = window.room;
  const WallGeometry wall = scene.walls[static_cast<std::size_t>(
      scene.rooms[static_cast<std::size_t>(r)].walls[static_cast<std::size_t>(plan.wall)])];
  const Stand stand = stand_at(wall);
  const Opening o{plan.along - 0.5 * plan.width, plan.along + 0.5 * plan.width, plan.sill,
                  plan.sill + plan.height};
  const Tag pane = builder.add_instance(SceneClass::window, r);
  window.instance = pane.instance;
  const Tag frame = builder.add_instance(SceneClass::window, r, "frame");
  const Eigen::Vector3d x = stand.direction(Eigen::Vector3d::UnitX());
  if (plan.view == "picture")
    builder
        .add_rectangle(pane, stand.at({o.along_max, -pane_depth_m, o.z_min}), -x, Eigen::Vector3d::UnitZ(),
                       {plan.width, plan.height}, {"outside", plan.seed, {255, 255, 255}})
        .emission = 1.0f;
  else
    add_window_view(builder, plan, pane, stand, o, pane_depth_m);
  add_reveal(builder, frame, stand, o, niche_depth_m, white_wood, white_wood, frame);
  add_window_frame(builder, frame, stand, o);
  if (plan.radiator && plan.sill > 0.5) add_radiator(builder, plan, r, stand);
  if (plan.curtain) add_curtain(builder, plan, r, wall, stand);
  const Eigen::Vector2d n = wall.normal;
  scene.lights.push_back({stand.at({plan.along, 0.05, plan.sill + 0.5 * plan.height}),
                          {n.x(), n.y(), 0},
                          0.8 * plan.width * plan.height,
                          r});
}

}  // namespace

void build_openings(SceneAssembly& builder) {
  for (std::size_t i = 0; i < builder.plan().doors.size(); ++i) add_door(builder, i);
  for (std::size_t i = 0; i < builder.plan().windows.size(); ++i) add_window(builder, i);
}

}  // namespace vsgraphs
