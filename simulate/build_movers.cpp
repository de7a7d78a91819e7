// Door leaves that turn, people of jointed boxes, trolleys, and the robot that carries the camera.
#include <cmath>
#include <numbers>

#include "core/base/check.h"
#include "simulate/canvas.h"
#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

using Eigen::Vector3d;

constexpr double casing_m = 0.018, leaf_m = 0.04;
const Stand own_frame{};

struct Leaf {
  Eigen::Vector2d hinge, closed;  // where it hangs, and which way it lies when closed
  double side, width, offset;     // side: 1 hinged on the left; offset: of its middle from the hinge line
};

int add_mover(SceneAssembly& builder, const Mover& mover) {
  builder.scene().movers.push_back(mover);
  return static_cast<int>(builder.scene().movers.size()) - 1;
}

void add_leaf_faces(SceneAssembly& builder, const Tag& tag, const Leaf& leaf, double height) {
  const double half = 0.5 * leaf_m, y = -leaf.side * leaf.offset;
  const Material panel{"door_leaf", builder.plan().seed, {196, 188, 176}}, rim{"lacquer", 3, {206, 202, 194}};
  const Vector3d low(0.01, y - half, 0.01), high(leaf.width, y + half, height - 0.02);
  const unsigned thin = BoxSide::left | BoxSide::right | BoxSide::top | BoxSide::bottom;
  builder.add_box(tag, own_frame, low, high, rim, thin);
  builder.add_box(tag, own_frame, low, high, panel, BoxSide::front | BoxSide::back);
  for (const double at : {low.y() - 0.05, high.y()})
    builder.add_box(tag, own_frame, {leaf.width - 0.11, at, 0.95}, {leaf.width - 0.07, at + 0.05, 1.1},
                    {"lacquer", 5, {86, 88, 94}});
}

void hang_leaf(SceneAssembly& builder, const Tag& tag, const DoorLeafPlan& plan, const DoorGeometry& door,
               const Leaf& leaf, const std::string& name) {
  Mover mover;
  mover.kind = Mover::Kind::hinge;
  Eigen::Matrix3d axes;
  axes << leaf.closed.x(), -leaf.closed.y(), 0, leaf.closed.y(), leaf.closed.x(), 0, 0, 0, 1;
  mover.base = Se3(axes, {leaf.hinge.x(), leaf.hinge.y(), door.z});
  const double to_rad = -leaf.side * std::numbers::pi / 180;
  mover.turns.emplace_back(0, to_rad * plan.angle_deg);
  for (const Eigen::Vector2d& turn : plan.turns) mover.turns.emplace_back(turn.x(), to_rad * turn.y());
  const std::size_t begin = builder.scene().faces.size();
  add_leaf_faces(builder, tag, leaf, door.height);
  builder.set_mover(begin, add_mover(builder, mover));
  const Se3 placed = mover.base * Se3(so3_exp({0, 0, mover.turns.front().y()}), Vector3d::Zero());
  const Vector3d middle = placed * Vector3d(0.5 * leaf.width, -leaf.side * leaf.offset, 0);
  const Vector3d reach = placed.rotation().col(0);
  builder.scene().solids.push_back({middle.head<2>(),
                                    {0.5 * leaf.width, 0.5 * leaf_m},
                                    std::atan2(reach.y(), reach.x()),
                                    door.z,
                                    door.z + door.height,
                                    name});
}

struct Limb {
  Vector3d joint;      // on the body: forward, left, up
  Vector3d low, high;  // of its box about the joint
  double swing;
  Material material;
};

std::vector<Limb> limbs_of(const MoverPlan& plan) {
  Rng rng(plan.seed, "person", 0);
  const Material shirt{"rug", plan.seed, random_hue(rng, 0.55, 0.7)},
      trousers{"cloth", plan.seed, random_hue(rng, 0.3, 0.4)}, skin{"cloth", 31, {196, 152, 124}},
      hair{"carpet", plan.seed, {70, 52, 38}};
  const bool sits = plan.pose == "sit";
  const double hip = sits ? 0.48 : 0.88, step = plan.pose == "walk" ? 0.55 : 0.0;
  std::vector<Limb> limbs{{{0, 0, hip}, {-0.12, -0.2, -0.04}, {0.12, 0.2, 0.6}, 0, shirt},
                          {{0, 0, hip + 0.62}, {-0.1, -0.08, 0}, {0.11, 0.08, 0.17}, 0, skin},
                          {{0, 0, hip + 0.78}, {-0.11, -0.09, 0}, {0.09, 0.09, 0.07}, 0, hair}};
  for (const double side : {-1.0, 1.0}) {
    limbs.push_back({{0, 0.26 * side, hip + 0.56},
                     {-0.06, -0.055, -0.62},
                     {0.06, 0.055, 0.03},
                     0.7 * step * side,
                     shirt});
    if (sits) {
      limbs.push_back({{0, 0.11 * side, hip}, {-0.05, -0.09, -0.07}, {0.48, 0.09, 0.08}, 0, trousers});
      limbs.push_back({{0.42, 0.11 * side, hip}, {-0.07, -0.08, -hip}, {0.07, 0.08, 0}, 0, trousers});
    } else {
      limbs.push_back(
          {{0, 0.1 * side, hip}, {-0.08, -0.085, -0.87}, {0.08, 0.085, 0}, -step * side, trousers});
    }
  }
  return limbs;
}

std::vector<Limb> trolley_parts() {
  const Material metal{"lacquer", 41, {120, 124, 130}}, wheel{"lacquer", 42, {40, 40, 42}};
  std::vector<Limb> parts{
      {{0, 0, 0}, {-0.45, -0.28, 0.12}, {0.45, 0.28, 0.17}, 0, metal},
      {{0, 0, 0}, {-0.3, -0.22, 0.17}, {0.25, 0.2, 0.5}, 0, {"parcel", 43, {156, 112, 66}}},
      {{0, 0, 0}, {-0.2, -0.18, 0.5}, {0.15, 0.12, 0.75}, 0, {"parcel", 44, {170, 126, 80}}},
      {{0, 0, 0}, {-0.46, -0.28, 0.95}, {-0.42, 0.28, 1.0}, 0, metal}};
  for (const double y : {-0.28, 0.24}) {
    parts.push_back({{0, 0, 0}, {-0.46, y, 0.12}, {-0.42, y + 0.04, 1.0}, 0, metal});
    for (const double x : {-0.4, 0.3})
      parts.push_back({{0, 0, 0}, {x, y, 0}, {x + 0.1, y + 0.04, 0.12}, 0, wheel});
  }
  return parts;
}

void add_walker(SceneAssembly& builder, std::size_t index) {
  const MoverPlan plan = builder.plan().movers[index];
  const std::string key = "movers[" + std::to_string(index) + "]";
  const int r = builder.room_index(plan.room, key + ".room");
  const bool person = plan.kind == "person", walks = !person || plan.pose == "walk";
  require_input(walks || plan.way.size() == 1, key + ".way: who does not walk has one place");
  Scene& scene = builder.scene();
  const Tag tag =
      builder.add_instance(person ? SceneClass::person : SceneClass::misc, r, person ? plan.pose : plan.kind);
  scene.moving.push_back(tag.instance);
  scene.walks.emplace_back(plan.way, plan.speed, plan.start_s, plan.yaw_deg * std::numbers::pi / 180,
                           scene.plan.rooms[static_cast<std::size_t>(r)].z_floor);
  for (const Limb& limb : person ? limbs_of(plan) : trolley_parts()) {
    Mover mover;
    mover.kind = Mover::Kind::limb;
    mover.base = Se3(Eigen::Matrix3d::Identity(), limb.joint);
    mover.walk = static_cast<int>(scene.walks.size()) - 1;
    mover.swing_rad = limb.swing;
    const std::size_t begin = scene.faces.size();
    builder.add_box(tag, own_frame, limb.low, limb.high, limb.material);
    builder.set_mover(begin, add_mover(builder, mover));
  }
}

// A deck below the camera, a bumper at its front edge, and a post at each side.
void add_robot(SceneAssembly& builder, const RobotPlan& plan) {
  const Tag tag = builder.add_instance(SceneClass::robot, -1, "robot");
  Mover mover;
  mover.kind = Mover::Kind::rig;
  Eigen::Matrix3d axes;  // x forward, y left, z up, in the camera's
  axes << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  mover.base = Se3(axes, Vector3d::Zero());
  const std::size_t begin = builder.scene().faces.size();
  const double half = 0.5 * plan.width, top = -plan.below;
  const Material deck{"terrazzo", 51, {62, 64, 70}}, bumper{"lacquer", 52, {30, 30, 32}},
      post{"lacquer", 53, {150, 40, 36}};
  builder.add_box(tag, own_frame, {-0.3, -half, top - 0.05}, {plan.ahead, half, top}, deck);
  builder.add_box(tag, own_frame, {plan.ahead, -half - 0.02, top - 0.09},
                  {plan.ahead + 0.03, half + 0.02, top + 0.01}, bumper);
  for (const double y : {-half, half - 0.03})
    builder.add_box(tag, own_frame, {plan.ahead - 0.06, y, top}, {plan.ahead - 0.03, y + 0.03, top + 0.05},
                    post);
  builder.set_mover(begin, add_mover(builder, mover));
}

}  // namespace

void add_turning_leaf(SceneAssembly& builder, const DoorLeafPlan& plan, DoorGeometry& door, int index) {
  const bool first = builder.plan().rooms[static_cast<std::size_t>(door.rooms[0])].id == plan.room;
  const WallGeometry wall = builder.scene().walls[static_cast<std::size_t>(door.walls[first ? 0 : 1])];
  const Eigen::Vector2d face = door.center + 0.5 * door.thickness * (first ? 1.0 : -1.0) * door.normal;
  const double offset = plan.set_back > 0 ? -plan.set_back - 0.5 * leaf_m : casing_m + 0.5 * leaf_m;
  const double width = plan.pair ? 0.5 * door.width : door.width;
  for (const bool second : {false, true}) {
    if (second && !plan.pair) break;
    const double side = (plan.hinge == "left") != second ? 1.0 : -1.0;
    const Tag tag{SceneClass::door, builder.add_instance(SceneClass::door, -1, "leaf", -1, index).instance,
                  wall.room};
    (second ? door.second_leaf_instance : door.leaf_instance) = tag.instance;
    // The leaf's middle lies off the hinge line by `offset`, towards the room or into the wall.
    const Leaf leaf{face + side * 0.5 * door.width * wall.along, -side * wall.along, side, width - 0.015,
                    offset};
    hang_leaf(builder, tag, plan, door, leaf, "doors[" + std::to_string(index) + "] (leaf)");
  }
}

void build_movers(SceneAssembly& builder) {
  for (std::size_t i = 0; i < builder.plan().movers.size(); ++i) add_walker(builder, i);
  if (const auto robot = builder.plan().path.robot) add_robot(builder, *robot);
}

}  // namespace vsgraphs
