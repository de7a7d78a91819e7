// A frame on its way through tracking, and afterwards the last one that had a pose.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/map/depth_grid.h"
#include "core/map/features.h"
#include "core/map/keyframe.h"
#include "core/matching/frame_pose.h"

namespace vsgraphs {

struct FrameState {
  std::int64_t index = 0;
  double timestamp_s = 0;
  std::shared_ptr<const FeatureSet> features;  // undistorted px
  std::shared_ptr<const DepthGrid> surface;    // camera frame, m
  std::vector<LandmarkId> landmarks;           // per feature; invalid where none
  KeyframeId surface_reference;  // whose surfaces held the pose; invalid where they were not needed
  std::optional<TrackedLink> tracked_link;  // where landmarks are too few
  AnchoredPose pose;

  int features_with_depth() const {
    return static_cast<int>(std::count_if(features->features().begin(), features->features().end(),
                                          [](const Feature& f) { return f.has_depth(); }));
  }
  int matched_landmarks() const {
    return static_cast<int>(
        std::count_if(landmarks.begin(), landmarks.end(), [](LandmarkId id) { return id.valid(); }));
  }
  void adopt(const FrameMatches& matches) {
    for (const Correspondence& c : matches.all()) {
      if (c.landmark.valid()) landmarks[static_cast<std::size_t>(c.feature)] = c.landmark;
    }
  }
};

}  // namespace vsgraphs
