// For tests: a map of planes that one keyframe saw, as far as they are given, and what is known of them. The world is level.
#pragma once

#include "core/map/test_map.h"
#include "core/scene/surfaces/surface_keeper.h"
#include "core/scene/surfaces/test_surfaces.h"
#include "core/understanding/element_kind.h"

namespace vsgraphs::test {

class SeenPlanes {
 public:
  SeenPlanes() { map.apply(vsgraphs::SetUp{Eigen::Vector3d::UnitZ()}); }

  // A rectangle around `centre`, spanned by `a` and `b` (half its sides), facing a x b.
  PlaneId see(SurfaceRole role, const Eigen::Vector3d& centre, const Eigen::Vector3d& a,
              const Eigen::Vector3d& b) {
    SurfacePatch patch;
    patch.plane = plane_at(centre, a.cross(b).normalized());
    patch.area_m2 = static_cast<float>(4 * a.norm() * b.norm());
    constexpr int steps = 20;
    for (int i = -steps; i <= steps; ++i)
      for (int j = -steps; j <= steps; ++j)
        patch.points.push_back(
            (centre + i / static_cast<double>(steps) * a + j / static_cast<double>(steps) * b).cast<float>());
    const KeyframeId keyframe = add_keyframe(map, keyframe_seeing(Camera{}, Se3{}, {}));
    map.apply(
        SetPatches{keyframe, std::make_shared<const KeyframeSurfaces>(KeyframeSurfaces{{patch}, false})});
    MappedPlane plane;
    plane.plane = patch.plane;
    plane.role = role;
    const PlaneId id = map.planes().next_id();
    map.apply(AddPlane{id, plane});
    map.apply(AddPlaneObservation{id, {keyframe, 0}});
    surfaces.gather(map);
    return id;
  }
  // A room of the given corners of its floor, 2.6 m high.
  void add_room(RoomNumber number, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    FoundRoom room;
    room.number = number;
    room.polygon = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    room.height_m = 2.6;
    structure.rooms.push_back(room);
  }
  std::vector<FoundElement> find(const ElementKind& kind) {
    ElementNumber next = 0;
    return find_elements(std::span(&kind, 1), {map, surfaces, structure}, {}, next);
  }

  Map map;
  SurfaceKeeper surfaces;
  FoundStructure structure;
};

}  // namespace vsgraphs::test
