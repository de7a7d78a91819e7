#include "core/stages/structure_builder.h"

#include <algorithm>

#include "core/scene/plane_extent.h"
#include "core/scene/up_direction.h"

namespace vsgraphs {
namespace {

// One point for each cell in which the plane was seen.
std::vector<Eigen::Vector3f> seen_points(const Map& map, const MappedPlane& plane,
                                         const Se3& level_from_world) {
  const PlaneExtent extent = extent_of(map, plane);
  std::vector<Eigen::Vector3f> points;
  const auto& cells = extent.cells();
  for (int t = cells.min_t(); t < cells.end_t(); ++t) {
    for (int s = cells.min_s(); s < cells.end_s(); ++s) {
      if (!cells.at({s, t})) continue;
      const Eigen::Vector3d middle =
          extent.frame().point((s + 0.5) * PlaneExtent::cell_m, (t + 0.5) * PlaneExtent::cell_m);
      points.push_back((level_from_world * middle).cast<float>());
    }
  }
  return points;
}

SceneFaces faces_of(const Map& map, const Se3& level_from_world) {
  SceneFaces faces;
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    auto* list = plane.role == SurfaceRole::wall      ? &faces.walls
                 : plane.role == SurfaceRole::ground  ? &faces.grounds
                 : plane.role == SurfaceRole::ceiling ? &faces.ceilings
                                                      : nullptr;
    if (list)
      list->push_back(
          {id, plane.plane.transformed(level_from_world), seen_points(map, plane, level_from_world)});
  });
  return faces;
}

void place_nodes(const Map& map, FoundStructure& found) {
  for (const FoundRoom& room : found.rooms) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const PlaneId id : room.walls) {
      const MappedPlane& wall = *map.planes().find(id);
      sum += wall.plane.project(map.observed_centre(wall));
    }
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

MapEdit StructureBuilder::propose(const Snapshot& snapshot, const SpaceKeeper& space, double timestamp_s,
                                  TraceSink* trace) {
  last_pass_s_ = timestamp_s;
  Draft draft(snapshot);
  const Map& map = draft.map();
  if (!map.up_in_world()) return draft.take();
  const Se3 level_from_world = levelling(*map.up_in_world());
  const Span span(trace, "find_rooms");
  auto found = std::make_shared<FoundStructure>(recognise_structure(
      space.view(), faces_of(map, level_from_world), map.structure(), options_.structure));
  found->sought = true;
  found->level_from_world = level_from_world;
  place_nodes(map, *found);
  draft.record(SetStructure{std::move(found)});
  return draft.take();
}

}  // namespace vsgraphs
