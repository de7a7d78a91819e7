#include "core/stages/structure_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>


namespace vsgraphs {
namespace {

Se3 levelling(const Eigen::Vector3d& up) {
  return {Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          Eigen::Vector3d::Zero()};
}

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
      list->push_back(
          {id, plane.plane.transformed(level_from_world), seen_points(plane, surfaces.find(id), level_from_world)});
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

MapEdit StructureBuilder::propose(const Snapshot& snapshot, const SurfaceKeeper& surfaces, double timestamp_s,
                                  bool last, TraceSink* trace) {
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
      recognise_structure(free_space_, faces_of(map, surfaces, level_from_world), map.structure(), options_.structure));
  found->sought = true;
  found->level_from_world = level_from_world;
  place_nodes(map, surfaces, *found);
  draft.record(SetStructure{std::move(found)});
  return draft.take();
}

}  // namespace vsgraphs
