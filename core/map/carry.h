// What moves with what: the one place that says what a change of keyframe poses does to everything anchored to them.
#pragma once

#include <optional>
#include <vector>

#include "core/map/map.h"

namespace vsgraphs {

// A value moved rigidly together with the world around it, world from world.
MoveKeyframe moved(KeyframeId id, const Keyframe& keyframe, const Se3& by);
MoveLandmark moved(LandmarkId id, const Landmark& landmark, const Se3& by);
MovePlane moved(PlaneId id, const MappedPlane& plane, const Se3& by);
MoveMarker moved(MarkerId id, const MappedMarker& marker, const Se3& by);

// By keyframe index: what moves the keyframe and its surroundings, world from world. Identity where there is no keyframe.
using Corrections = std::vector<Se3>;

// The living keyframe something is anchored to; empty if none is left. A landmark is anchored to the first keyframe that observes it, a
// marker on the first one, or its anchor, that saw it where it hangs.
std::optional<KeyframeId> carrier_of(const Landmark& landmark);
std::optional<KeyframeId> carrier_of(const Map& map, const MappedMarker& marker);

// Where things that are anchored to keyframes of `map` end up when those are corrected. Refers to both arguments; empty for a thing
// that no living keyframe holds.
class Carry {
 public:
  Carry(const Map& map, const Corrections& corrections) : map_(map), corrections_(corrections) {}

  MoveKeyframe keyframe(KeyframeId id) const;
  std::optional<MoveLandmark> landmark(LandmarkId id) const;
  // By the mean of those that see it, through their anchors where they were culled.
  std::optional<MovePlane> plane(PlaneId id) const;
  std::optional<MoveMarker> marker(MarkerId id) const;
  // Rooms' nodes by the mean of their walls' observers, floors' with their rooms. Polygons, doors and places are sought again.
  std::optional<MoveStructureNodes> structure_nodes() const;

 private:
  const Se3& correction(KeyframeId id) const { return corrections_[id.index]; }
  std::vector<KeyframeId> observers(const MappedPlane& plane) const;
  std::optional<Eigen::Vector3d> room_node(const FoundRoom& room, const Eigen::Vector3d& node) const;

  const Map& map_;
  const Corrections& corrections_;
};

// All of the map but its rooms, keyframes first; with `known` only what that map does not hold.
std::vector<EditOperation> carry(const Map& map, const Corrections& corrections, const Map* known = nullptr);

}  // namespace vsgraphs
