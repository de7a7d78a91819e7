#include "core/map/carry.h"

#include <algorithm>

namespace vsgraphs {

MoveKeyframe moved(KeyframeId id, const Keyframe& keyframe, const Se3& by) {
  return {id, (by * keyframe.world_from_camera).normalized()};
}

MoveLandmark moved(LandmarkId id, const Landmark& landmark, const Se3& by) {
  const Eigen::Vector3d direction = landmark.appearance.view_direction.cast<double>();
  return {id, by * landmark.point_in_world, (by.rotation() * direction).cast<float>()};
}

MovePlane moved(PlaneId id, const MappedPlane& plane, const Se3& by) {
  return {id, plane.plane.transformed(by)};
}

MoveMarker moved(MarkerId id, const MappedMarker& marker, const Se3& by) {
  return {id, (by * marker.world_from_marker).normalized()};
}

std::optional<KeyframeId> carrier_of(const Landmark& landmark) {
  if (landmark.observations.empty()) return std::nullopt;
  return landmark.observations.front().keyframe;
}

std::optional<KeyframeId> carrier_of(const Map& map, const MappedMarker& marker) {
  const MarkerSightings sightings = map.sightings(marker);
  if (sightings.places.empty()) return std::nullopt;
  const std::size_t first = sightings.places.front().observations.front();
  return map.reanchor({marker.observations[first].keyframe, Se3{}})->keyframe;
}

MoveKeyframe Carry::keyframe(KeyframeId id) const {
  return moved(id, *map_.keyframes().find(id), correction(id));
}

std::optional<MoveLandmark> Carry::landmark(LandmarkId id) const {
  const Landmark* landmark = map_.landmarks().find(id);
  const auto carrier = landmark ? carrier_of(*landmark) : std::nullopt;
  if (!carrier) return std::nullopt;
  return moved(id, *landmark, correction(*carrier));
}

std::optional<MoveMarker> Carry::marker(MarkerId id) const {
  const auto at = map_.markers().find(id);
  const auto carrier = at == map_.markers().end() ? std::nullopt : carrier_of(map_, *at->second);
  if (!carrier) return std::nullopt;
  return moved(id, *at->second, correction(*carrier));
}

std::vector<KeyframeId> Carry::observers(const MappedPlane& plane) const {
  std::vector<KeyframeId> living;
  for (const PlaneObservation& o : plane.observations) {
    if (const auto anchor = map_.reanchor({o.keyframe, Se3{}})) living.push_back(anchor->keyframe);
  }
  return living;
}

std::optional<MovePlane> Carry::plane(PlaneId id) const {
  const MappedPlane* plane = map_.planes().find(id);
  const std::vector<KeyframeId> by = plane ? observers(*plane) : std::vector<KeyframeId>{};
  if (by.empty()) return std::nullopt;
  if (std::all_of(by.begin(), by.end(), [&by](KeyframeId k) { return k == by.front(); }))
    return moved(id, *plane, correction(by.front()));
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(), anchor = Eigen::Vector3d::Zero();
  std::vector<AnchoredPlane> seen;
  for (const KeyframeId keyframe : by) {
    seen.push_back(plane->plane.transformed(correction(keyframe)));
    normal += seen.back().normal;
    anchor += seen.back().anchor;
  }
  if (normal.norm() < 1e-3) return std::nullopt;  // turned all ways: no mean
  AnchoredPlane mean{normal.normalized(), anchor / static_cast<double>(seen.size()), 0};
  for (const AnchoredPlane& s : seen) mean.offset_m += s.signed_distance(mean.anchor);
  mean.offset_m /= static_cast<double>(seen.size());
  return MovePlane{id, mean};
}

std::optional<Eigen::Vector3d> Carry::room_node(const FoundRoom& room, const Eigen::Vector3d& node) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int walls = 0;
  for (const PlaneId wall : room.walls) {
    const MappedPlane* plane = map_.planes().find(wall);
    const std::vector<KeyframeId> by = plane ? observers(*plane) : std::vector<KeyframeId>{};
    if (by.empty()) continue;
    Eigen::Vector3d with_wall = Eigen::Vector3d::Zero();
    for (const KeyframeId keyframe : by) with_wall += correction(keyframe) * node;
    sum += with_wall / static_cast<double>(by.size());
    ++walls;
  }
  if (walls == 0) return std::nullopt;
  return sum / walls;
}

std::optional<MoveStructureNodes> Carry::structure_nodes() const {
  const FoundStructure& structure = map_.structure();
  if (structure.room_nodes.empty() || structure.room_nodes.size() != structure.rooms.size() ||
      structure.floor_nodes.size() != structure.floors.size())
    return std::nullopt;
  MoveStructureNodes moves{structure.room_nodes, structure.floor_nodes};
  for (std::size_t i = 0; i < structure.rooms.size(); ++i)
    moves.rooms[i] = room_node(structure.rooms[i], structure.room_nodes[i]).value_or(structure.room_nodes[i]);
  for (std::size_t f = 0; f < structure.floors.size(); ++f) {
    const auto& rooms = structure.floors[f].rooms;
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    int count = 0;
    for (std::size_t i = 0; i < structure.rooms.size(); ++i) {
      if (std::find(rooms.begin(), rooms.end(), structure.rooms[i].number) == rooms.end()) continue;
      shift += moves.rooms[i] - structure.room_nodes[i];
      ++count;
    }
    if (count > 0) moves.floors[f] += shift / count;
  }
  return moves;
}

std::vector<EditOperation> carry(const Map& map, const Corrections& corrections, const Map* known) {
  const Carry carried(map, corrections);
  std::vector<EditOperation> moves;
  const auto record = [&moves](auto&& move) {
    if (move) moves.emplace_back(*std::move(move));
  };
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) {
    if (!known || !known->keyframes().contains(id)) moves.emplace_back(carried.keyframe(id));
  });
  map.landmarks().for_each([&](LandmarkId id, const Landmark&) {
    if (!known || !known->landmarks().contains(id)) record(carried.landmark(id));
  });
  map.planes().for_each([&](PlaneId id, const MappedPlane&) {
    if (!known || !known->planes().contains(id)) record(carried.plane(id));
  });
  for (const auto& [id, marker] : map.markers()) {
    if (!known || !known->markers().contains(id)) record(carried.marker(id));
  }
  return moves;
}

}  // namespace vsgraphs
