// Thin walls that stand free in a room, of glass or not, and what is seen through windows.
#include <cmath>

#include "core/base/check.h"
#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

const Material metal{"lacquer", 9, {92, 94, 98}};
const Material board{"cloth", 12, {122, 134, 128}};
constexpr double post_m = 0.05;

// Lights the faces added since `begin` as by day.
void by_daylight(SceneAssembly& builder, std::size_t begin, float brightness) {
  for (std::size_t i = begin; i < builder.scene().faces.size(); ++i)
    builder.scene().faces[i].emission = brightness;
}

void add_glass_partition(SceneAssembly& builder, const Tag& glass, const PartitionPlan& plan,
                         const Stand& stand, double length) {
  const Tag frame{SceneClass::glass, builder.add_instance(SceneClass::glass, glass.room, "mullion").instance,
                  glass.room};
  const double half = 0.5 * plan.thickness;
  const int fields = std::max(1, static_cast<int>(std::lround(length / plan.mullions)));
  for (int i = 0; i <= fields; ++i) {
    const double x = (length - post_m) * i / fields;
    builder.add_box(frame, stand, {x, -half, 0}, {x + post_m, half, plan.height}, metal,
                    all_sides & ~BoxSide::bottom);
  }
  for (const double z : {0.0, plan.height - post_m})
    builder.add_box(frame, stand, {0, -half, z}, {length, half, z + post_m}, metal);
  const Eigen::Vector3d x = stand.direction(Eigen::Vector3d::UnitX());
  add_pane(builder, glass, stand.at({0, 0, post_m}), x, {length, plan.height - 2 * post_m});
}

void add_partition(SceneAssembly& builder, std::size_t index) {
  const PartitionPlan plan = builder.plan().partitions[index];
  const std::string key = "partitions[" + std::to_string(index) + "]";
  const int r = builder.room_index(plan.room, key + ".room");
  const RoomPlan room = builder.plan().rooms[static_cast<std::size_t>(r)];
  for (const Eigen::Vector2d& p : {plan.from, plan.to})
    require_input(contains(room.polygon, p) || distance_to_boundary(room.polygon, p) < 0.05,
                  key + ": lies outside room \"" + plan.room + "\"");
  require_input(plan.height <= room.height, key + ".height: is higher than its room");
  const Eigen::Vector2d along = (plan.to - plan.from).normalized();
  const double length = (plan.to - plan.from).norm(), half = 0.5 * plan.thickness;
  const Stand stand{{plan.from.x(), plan.from.y(), room.z_floor}, along};
  const bool glass = plan.kind == "glass";
  const Tag tag = builder.add_instance(glass ? SceneClass::glass : SceneClass::wall, r, "partition");
  if (glass)
    add_glass_partition(builder, tag, plan, stand, length);
  else
    builder.add_box(tag, stand, {0, -half, 0}, {length, half, plan.height}, board,
                    all_sides & ~BoxSide::bottom);
  const Eigen::Vector2d middle = 0.5 * (plan.from + plan.to);
  builder.scene().solids.push_back({middle,
                                    {0.5 * length, half},
                                    std::atan2(along.y(), along.x()),
                                    room.z_floor,
                                    room.z_floor + plan.height,
                                    key});
  builder.scene().partitions.push_back({r,
                                        {plan.from.x(), plan.from.y(), room.z_floor},
                                        {plan.to.x(), plan.to.y(), room.z_floor},
                                        tag.instance});
}

// A balcony: its floor and a wall of breast height before it, and the sky.
void add_parapet(SceneAssembly& builder, const Tag& tag, const Stand& stand, const Opening& o) {
  const double wide = 2.5, deep = 1.5, y = -0.3;
  const double x0 = o.along_min - wide, x1 = o.along_max + wide;
  const Eigen::Vector3d x = stand.direction(Eigen::Vector3d::UnitX()), z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d back = stand.direction(-Eigen::Vector3d::UnitY());
  builder.add_rectangle(tag, stand.at({x1, y, -0.05}), -x, back, {x1 - x0, deep},
                        {"concrete", 21, {150, 148, 140}});
  builder.add_box(tag, stand, {x0, y - deep - 0.15, -0.05}, {x1, y - deep, 0.95},
                  {"brick", 22, {160, 120, 96}});
  builder.add_rectangle(tag, stand.at({x1 + 20, y - 30, -15}), -x, z, {x1 - x0 + 40, 40},
                        {"lacquer", 23, {205, 218, 236}});
}

// The house opposite with its windows, the street between, and the sky.
void add_street(SceneAssembly& builder, const Tag& tag, const Stand& stand, const Opening& o,
                std::uint64_t seed) {
  Rng rng(seed, "street", 0);
  const double away = rng.uniform(8, 13), low = -3.2, high = low + rng.uniform(9, 13), wide = 14;
  const double middle = 0.5 * (o.along_min + o.along_max);
  const Eigen::Vector3d x = stand.direction(Eigen::Vector3d::UnitX()), z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d back = stand.direction(-Eigen::Vector3d::UnitY());
  const auto wall = [&](double along, double height, double depth, const Eigen::Vector2d& size,
                        const Material& m) {
    builder.add_rectangle(tag, stand.at({along + size.x(), -depth, height}), -x, z, size, m);
  };
  wall(middle - 40, -20, 60, {80, 60}, {"lacquer", 23, {205, 218, 236}});
  builder.add_rectangle(tag, stand.at({middle + wide, -0.4, low}), -x, back, {2 * wide, away},
                        {"concrete", 24, {120, 120, 118}});
  wall(middle - wide, low, away, {2 * wide, high - low}, {"brick", 25 + seed % 3, {168, 132, 108}});
  for (double h = low + 1; h + 1.6 < high; h += 2.9)
    for (double a = middle - wide + 1; a + 1.2 < middle + wide; a += 2.6)
      wall(a, h, away - 0.05, {1.2, 1.5},
           {"outside", seed + static_cast<std::uint64_t>(10 * h + 40) % 4, {255, 255, 255}});
}

}  // namespace

void add_pane(SceneAssembly& builder, const Tag& tag, const Eigen::Vector3d& corner,
              const Eigen::Vector3d& s_axis, const Eigen::Vector2d& size) {
  const Material clear{"lacquer", 1, {200, 210, 210}};
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  builder.add_rectangle(tag, corner, s_axis, z, size, clear).optics = Optics::glass;
  builder.add_rectangle(tag, corner + size.x() * s_axis, -s_axis, z, size, clear).optics = Optics::glass;
}

void add_window_view(SceneAssembly& builder, const WindowPlan& plan, const Tag& pane, const Stand& stand,
                     const Opening& outline, double pane_depth) {
  const Eigen::Vector3d x = stand.direction(Eigen::Vector3d::UnitX());
  add_pane(builder, pane, stand.at({outline.along_max, -pane_depth, outline.z_min}), -x,
           {plan.width, plan.height});
  const Tag outside = builder.add_instance(SceneClass::window, pane.room, plan.view);
  const std::size_t begin = builder.scene().faces.size();
  if (plan.view == "parapet")
    add_parapet(builder, outside, stand, outline);
  else
    add_street(builder, outside, stand, outline, plan.seed);
  by_daylight(builder, begin, 1.05f);
}

void build_partitions(SceneAssembly& builder) {
  for (std::size_t i = 0; i < builder.plan().partitions.size(); ++i) add_partition(builder, i);
}

}  // namespace vsgraphs
