// Flat things on walls: a thin box each, with the motif on its front.
#include <algorithm>

#include "core/base/check.h"
#include "core/simulate/scene_builder.h"

namespace vsgraphs {
namespace {

double thickness_of(const std::string& kind) {
  if (kind == "board" || kind == "clock") return 0.03;
  if (kind == "picture") return 0.02;
  if (kind == "socket" || kind == "switch") return 0.01;
  return 0.004;
}

void add_poster(SceneAssembly& builder, std::size_t index) {
  const PosterPlan& plan = builder.plan().posters[index];
  const std::string key = "posters[" + std::to_string(index) + "]";
  const int r = builder.room_index(plan.room, key + ".room");
  const auto& walls = builder.scene().rooms[static_cast<std::size_t>(r)].walls;
  require_input(plan.wall >= 0 && plan.wall < static_cast<int>(walls.size()),
                key + ".wall: room \"" + plan.room + "\" has walls 0.." + std::to_string(walls.size() - 1));
  const WallGeometry& wall =
      builder.scene().walls[static_cast<std::size_t>(walls[static_cast<std::size_t>(plan.wall)])];
  const double a0 = plan.along - 0.5 * plan.width, a1 = plan.along + 0.5 * plan.width;
  const double z0 = plan.z - 0.5 * plan.height, z1 = plan.z + 0.5 * plan.height;
  require_input(a0 >= 0 && a1 <= wall.length && z0 >= 0 && z1 <= wall.height,
                key + ": does not fit on its wall (" + std::to_string(wall.length) + " x " +
                    std::to_string(wall.height) + " m)");
  for (const Opening& o : wall.openings) {
    require_input(a1 < o.along_min || a0 > o.along_max || z1 < o.z_min || z0 > o.z_max,
                  key + ": hangs across a door or window");
  }
  const bool plate = plan.kind == "socket" || plan.kind == "switch";
  const Tag tag = builder.add_instance(plate ? SceneClass::misc : SceneClass::picture, r, plan.kind);
  const Stand stand{{wall.p0.x(), wall.p0.y(), wall.z_floor}, wall.along};
  builder.add_box(tag, stand, {a0, 0, z0}, {a1, thickness_of(plan.kind), z1}, {"lacquer", 1, {84, 84, 86}},
                  all_sides & ~BoxSide::back, Material{plan.kind, plan.seed, {255, 255, 255}});
}

}  // namespace

std::vector<std::string> poster_kinds() {
  return {"poster", "picture", "board", "clock", "notice", "socket", "switch"};
}

void build_posters(SceneAssembly& builder) {
  for (std::size_t i = 0; i < builder.plan().posters.size(); ++i) add_poster(builder, i);
}

}  // namespace vsgraphs
