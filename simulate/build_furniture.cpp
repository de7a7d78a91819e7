// Puts furniture and stairs where the plan wants them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/check.h"
#include "simulate/furniture.h"

namespace vsgraphs {
namespace {

constexpr double outside_tolerance_m = 0.01;

void check_footprint(const SceneAssembly& builder, int room, const Stand& stand, const Eigen::Vector2d& half,
                     const std::string& key) {
  const Polygon2& polygon = builder.plan().rooms[static_cast<std::size_t>(room)].polygon;
  for (const double x : {-half.x(), half.x()}) {
    for (const double y : {-half.y(), half.y()}) {
      const Eigen::Vector2d p = stand.at({x, y, 0}).head<2>();
      const bool ok = contains(polygon, p) || distance_to_boundary(polygon, p) < outside_tolerance_m;
      require_input(ok, key + ": its corner (" + std::to_string(p.x()) + ", " + std::to_string(p.y()) +
                            ") lies outside room \"" +
                            builder.plan().rooms[static_cast<std::size_t>(room)].id + "\"");
    }
  }
}

void add_box(SceneAssembly& builder, std::size_t index) {
  const BoxPlan plan = builder.plan().boxes[index];
  const std::string key = "boxes[" + std::to_string(index) + "] (" + plan.kind + ")";
  const int r = builder.room_index(plan.room, key + ".room");
  const RoomPlan& room = builder.plan().rooms[static_cast<std::size_t>(r)];
  const double yaw = plan.yaw_deg * std::numbers::pi / 180;
  const Stand stand{{plan.at.x(), plan.at.y(), room.z_floor + plan.z}, {std::cos(yaw), std::sin(yaw)}};
  const Eigen::Vector2d half = 0.5 * plan.size.head<2>();
  check_footprint(builder, r, stand, half, key);
  require_input(plan.z + plan.size.z() <= room.height + 1e-9, key + ": is higher than its room");
  for (const FurnitureKind& kind : furniture_table()) {
    if (plan.kind != kind.name) continue;
    const Tag tag = builder.add_instance(kind.label, r, plan.kind);
    Piece piece{builder,  tag, stand, half.x(), half.y(), plan.size.z(), plan.colour.value_or(kind.colour),
                plan.seed};
    kind.build(piece);
    const double z = stand.origin.z();
    builder.scene().solids.push_back({plan.at, half, yaw, z, z + plan.size.z(), key, kind.shading});
  }
}

void add_stairs(SceneAssembly& builder, std::size_t index) {
  const StairsPlan plan = builder.plan().stairs[index];
  const std::string key = "stairs[" + std::to_string(index) + "]";
  const int r = builder.room_index(plan.room, key + ".room");
  const RoomPlan& room = builder.plan().rooms[static_cast<std::size_t>(r)];
  const Eigen::Vector2d forward = (plan.to - plan.from).normalized();
  // The front of each step looks back at somebody coming up.
  const Stand stand{{plan.from.x(), plan.from.y(), room.z_floor}, {-forward.y(), forward.x()}};
  const double run = (plan.to - plan.from).norm(), half = 0.5 * plan.width;
  const Stand middle{stand.at({0, -0.5 * (run + plan.landing), 0}), stand.x};
  check_footprint(builder, r, middle, {half, 0.5 * (run + plan.landing)}, key);
  const Tag tag = builder.add_instance(SceneClass::stairs, r);
  const Material tread{"terrazzo", builder.plan().seed, {150, 146, 140}};
  for (int i = 0; i < plan.steps; ++i) {
    // The last riser stands at `to`; what follows it is the landing.
    const double near = plan.steps > 1 ? run * i / (plan.steps - 1) : run;
    const double top = plan.rise * (i + 1) / plan.steps;
    builder.add_box(tag, stand, {-half, -(run + plan.landing), 0}, {half, -near, top}, tread,
                    all_sides & ~BoxSide::bottom);
  }
}

}  // namespace

double ground_height(const Plan& plan, int room, const Eigen::Vector2d& at) {
  const RoomPlan& place = plan.rooms[static_cast<std::size_t>(room)];
  double ground = place.z_floor;
  for (const StairsPlan& s : plan.stairs) {
    if (s.room != place.id) continue;
    const Eigen::Vector2d forward = (s.to - s.from).normalized(), d = at - s.from;
    const double run = (s.to - s.from).norm(), x = d.dot(forward),
                 y = forward.x() * d.y() - forward.y() * d.x();
    if (std::abs(y) > 0.5 * s.width + 0.1 || x < 0 || x > run + s.landing + 0.1) continue;
    ground = std::max(ground, place.z_floor + s.rise * std::min(1.0, x / run));
  }
  return ground;
}

void build_furniture(SceneAssembly& builder) {
  for (std::size_t i = 0; i < builder.plan().boxes.size(); ++i) add_box(builder, i);
  for (std::size_t i = 0; i < builder.plan().stairs.size(); ++i) add_stairs(builder, i);
}

}  // namespace vsgraphs
