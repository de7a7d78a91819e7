// Flat things on walls: a thin box each, with the motif on its front.
#include <algorithm>

#include "core/base/check.h"
#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

double thickness_of(const std::string& kind) {
  if (kind == "board" || kind == "clock") return 0.03;
  if (kind == "picture") return 0.02;
  if (kind == "socket" || kind == "switch") return 0.01;
  return 0.004;
}

void add_mirror(SceneAssembly& builder, const WallSpot& spot) {
  const Tag tag = builder.add_instance(SceneClass::mirror, spot.room, "mirror");
  const Tag frame = builder.add_instance(SceneClass::picture, spot.room, "mirror frame");
  const double depth = 0.025, rim = 0.015;
  const Eigen::Vector3d front(spot.high.x(), depth, spot.high.z());
  builder.add_box(frame, spot.stand, spot.low, front, {"lacquer", 1, {84, 84, 86}},
                  all_sides & ~(BoxSide::back | BoxSide::front));
  const Eigen::Vector3d x = spot.stand.direction(Eigen::Vector3d::UnitX());
  const Eigen::Vector2d size(spot.high.x() - spot.low.x(), spot.high.z() - spot.low.z());
  Face& face = builder.add_rectangle(tag, spot.stand.at({spot.high.x(), depth - rim, spot.low.z()}), -x,
                                     Eigen::Vector3d::UnitZ(), size, {"lacquer", 1, {170, 176, 180}});
  face.optics = Optics::mirror;
  const Eigen::Vector3d middle =
      0.5 * (spot.low + Eigen::Vector3d(spot.high.x(), 2 * depth - 2 * rim, spot.high.z()));
  builder.scene().wall_mirrors.push_back({spot.room, spot.stand.at(middle),
                                          spot.stand.direction(Eigen::Vector3d::UnitY()), size.x(), size.y(),
                                          tag.instance});
}

void add_poster(SceneAssembly& builder, std::size_t index) {
  const PosterPlan& plan = builder.plan().posters[index];
  const WallSpot spot = spot_on_wall(builder, "posters[" + std::to_string(index) + "]", plan.room, plan.wall,
                                     {plan.along, plan.z}, {plan.width, plan.height});
  if (plan.kind == "mirror") return add_mirror(builder, spot);
  const bool plate = plan.kind == "socket" || plan.kind == "switch";
  const Tag tag = builder.add_instance(plate ? SceneClass::misc : SceneClass::picture, spot.room, plan.kind);
  const Eigen::Vector3d front(spot.high.x(), thickness_of(plan.kind), spot.high.z());
  builder.add_box(tag, spot.stand, spot.low, front, {"lacquer", 1, {84, 84, 86}}, all_sides & ~BoxSide::back,
                  Material{plan.kind, plan.seed, {255, 255, 255}});
}

}  // namespace

WallSpot spot_on_wall(const SceneAssembly& builder, const std::string& key, const std::string& room,
                      int wall_index, const Eigen::Vector2d& centre, const Eigen::Vector2d& size) {
  const int r = builder.room_index(room, key + ".room");
  const auto& walls = builder.scene().rooms[static_cast<std::size_t>(r)].walls;
  require_input(wall_index >= 0 && wall_index < static_cast<int>(walls.size()),
                key + ".wall: room \"" + room + "\" has walls 0.." + std::to_string(walls.size() - 1));
  const WallGeometry& wall =
      builder.scene().walls[static_cast<std::size_t>(walls[static_cast<std::size_t>(wall_index)])];
  const Eigen::Vector2d low = centre - 0.5 * size, high = centre + 0.5 * size;
  require_input(low.x() >= 0 && high.x() <= wall.length && low.y() >= 0 && high.y() <= wall.height,
                key + ": does not fit on its wall (" + std::to_string(wall.length) + " x " +
                    std::to_string(wall.height) + " m)");
  for (const Opening& o : wall.openings) {
    require_input(high.x() < o.along_min || low.x() > o.along_max || high.y() < o.z_min || low.y() > o.z_max,
                  key + ": hangs across a door or window");
  }
  return {r,
          {{wall.p0.x(), wall.p0.y(), wall.z_floor}, wall.along},
          {low.x(), 0, low.y()},
          {high.x(), 0, high.y()}};
}

std::vector<std::string> poster_kinds() {
  return {"poster", "picture", "board", "clock", "notice", "socket", "switch", "mirror"};
}

void build_posters(SceneAssembly& builder) {
  for (std::size_t i = 0; i < builder.plan().posters.size(); ++i) add_poster(builder, i);
}

}  // namespace vsgraphs
