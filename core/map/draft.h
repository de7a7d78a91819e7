// A private working copy of the map that writes down what is done to it.
#pragma once

#include "core/map/map.h"

namespace vsgraphs {

class Draft {
 public:
  explicit Draft(const Snapshot& snapshot) : map_(*snapshot) { edit_.based_on = snapshot->version(); }

  const Map& map() const { return map_; }

  KeyframeId add(Keyframe keyframe) {
    const KeyframeId id = map_.keyframes().next_id();
    keyframe.landmarks.clear();
    record(AddKeyframe{id, std::move(keyframe)});
    return id;
  }
  LandmarkId add(Landmark landmark) {
    const LandmarkId id = map_.landmarks().next_id();
    landmark.observations.clear();
    record(AddLandmark{id, std::move(landmark)});
    return id;
  }
  PlaneId add(MappedPlane plane) {
    const PlaneId id = map_.planes().next_id();
    plane.observations.clear();
    record(AddPlane{id, std::move(plane)});
    return id;
  }
  void record(EditOperation operation) {
    map_.apply(operation);
    edit_.operations.push_back(std::move(operation));
  }

  MapEdit take() { return std::move(edit_); }

 private:
  Map map_;
  MapEdit edit_;
};

}  // namespace vsgraphs
