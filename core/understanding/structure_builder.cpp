#include "core/understanding/structure_builder.h"

#include <algorithm>

#include "core/map/levelling.h"
#include "core/understanding/element_kind.h"

namespace vsgraphs {
namespace {

// One point for each cell in which the plane was seen.
std::vector<Eigen::Vector3f> seen_points(const MappedPlane& plane, const KnownSurface* known,
                                         const Se3& level_from_world) {
  std::vector<Eigen::Vector3f> points;
  if (!known) return points;
  for (const Eigen::Vector3d& middle : known->extent().points())
    points.push_back((level_from_world * plane.plane.project(middle)).cast<float>());
  return points;
}

SceneFaces faces_of(const Map& map, const SurfaceKeeper& surfaces, const Se3& level_from_world) {
  SceneFaces faces;
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    auto* list = plane.role == SurfaceRole::wall      ? &faces.walls
                 : plane.role == SurfaceRole::ground  ? &faces.grounds
                 : plane.role == SurfaceRole::ceiling ? &faces.ceilings
                                                      : nullptr;
    if (list)
      list->push_back({id, plane.plane.transformed(level_from_world),
                       seen_points(plane, surfaces.find(id), level_from_world)});
  });
  return faces;
}

Eigen::Vector3d middle_of(const Map& map, const SurfaceKeeper& surfaces, PlaneId id) {
  const AnchoredPlane& plane = map.planes().find(id)->plane;
  const KnownSurface* known = surfaces.find(id);
  return plane.project(known ? known->mean_middle(surfaces.stretches()) : plane.anchor);
}

void place_nodes(const Map& map, const SurfaceKeeper& surfaces, FoundStructure& found) {
  for (const FoundRoom& room : found.rooms) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const PlaneId id : room.walls) sum += middle_of(map, surfaces, id);
    found.room_nodes.push_back(sum / static_cast<double>(std::max<std::size_t>(1, room.walls.size())));
  }
  for (const FoundFloor& floor : found.floors) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < found.rooms.size(); ++i) {
      const bool on =
          std::find(floor.rooms.begin(), floor.rooms.end(), found.rooms[i].number) != floor.rooms.end();
      if (on) sum += found.room_nodes[i];
    }
    found.floor_nodes.push_back(sum / static_cast<double>(std::max<std::size_t>(1, floor.rooms.size())));
  }
}

}  // namespace

MapEdit StructureBuilder::propose(const Snapshot& snapshot, const SpaceKeeper& space,
                                  const SurfaceKeeper& surfaces, double timestamp_s, TraceSink* trace) {
  last_pass_s_ = timestamp_s;
  Draft draft(snapshot);
  const Map& map = draft.map();
  if (!map.up_in_world()) return draft.take();
  const Se3 level_from_world = levelling(map);
  const Span span(trace, "find_rooms");
  auto found = std::make_shared<FoundStructure>(recognise_structure(
      space.view(), faces_of(map, surfaces, level_from_world), map.structure(), options_.structure));
  found->sought = true;
  found->level_from_world = level_from_world;
  place_nodes(map, surfaces, *found);
  found->next_element = map.structure().next_element;
  const std::vector<ElementKind> kinds = sought_kinds(element_kinds(), map, surfaces);
  for (const ElementKind& kind : kinds) found->element_kinds.emplace_back(kind.name);
  found->elements =
      find_elements(kinds, {map, surfaces, *found}, map.structure().elements, found->next_element);
  draft.record(SetStructure{std::move(found)});
  return draft.take();
}

}  // namespace vsgraphs
