#include "core/stages/structure_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/scene/plane_extent.h"

namespace vsgraphs {
namespace {

Se3 levelling(const Eigen::Vector3d& up) {
  return {Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          Eigen::Vector3d::Zero()};
}

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

void StructureBuilder::carve(const Map& map, const Se3& level_from_world, bool last) {
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    if (keyframe.surface && !free_space_.views().contains(id))
      free_space_.integrate(id, keyframe.surface, level_from_world * keyframe.world_from_camera);
  });
  // Keyframes that went because others see the same take what they had carved along.
  std::vector<KeyframeId> forgotten;
  for (const auto& [id, view] : free_space_.views()) {
    const RetiredKeyframe* retired = map.retired_keyframes().find(id);
    if (retired && retired->replaced) forgotten.push_back(id);
  }
  for (const KeyframeId id : forgotten) free_space_.remove(id);
  std::vector<KeyframePose> poses;
  for (const auto& [id, view] : free_space_.views()) {
    if (const auto pose = map.resolve({id, Se3{}})) poses.push_back({id, level_from_world * *pose});
  }
  free_space_.refresh(poses, last ? std::numeric_limits<int>::max() : options_.max_reintegrations);
}

void StructureBuilder::switch_to(const FreeSpace* free_space) {
  last_pass_s_.reset();
  const FreeSpaceOptions& wanted = options_.free_space;
  const bool usable = free_space && free_space->options().voxel_m == wanted.voxel_m &&
                      free_space->options().range_m == wanted.range_m;
  free_space_ = usable ? *free_space : FreeSpace(wanted);
}

void StructureBuilder::absorb(const Map& map, const FreeSpace& free_space) {
  if (!map.up_in_world()) return;
  const Se3 level_from_world = levelling(*map.up_in_world());
  for (const auto& [id, view] : free_space.views()) {
    const auto pose = map.resolve({id, Se3{}});
    if (pose && !free_space_.views().contains(id))
      free_space_.integrate(id, view.depth, level_from_world * *pose);
  }
}

MapEdit StructureBuilder::propose(const Snapshot& snapshot, double timestamp_s, bool last, TraceSink* trace) {
  last_pass_s_ = timestamp_s;
  Draft draft(snapshot);
  const Map& map = draft.map();
  if (!map.up_in_world()) return draft.take();
  const Se3 level_from_world = levelling(*map.up_in_world());
  {
    const Span span(trace, "carve_free_space");
    carve(map, level_from_world, last);
  }
  const Span span(trace, "find_rooms");
  auto found = std::make_shared<FoundStructure>(
      recognise_structure(free_space_, faces_of(map, level_from_world), map.structure(), options_.structure));
  found->sought = true;
  found->level_from_world = level_from_world;
  place_nodes(map, *found);
  draft.record(SetStructure{std::move(found)});
  return draft.take();
}

}  // namespace vsgraphs
