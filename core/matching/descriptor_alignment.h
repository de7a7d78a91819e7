// The pose of a view without a prediction: its features are matched by descriptor with those of a view whose place in the
// map is known, a pose comes from RANSAC over three matches with depth, and is then solved over all that agree. What
// recovers a lost track does it with the last frame and with keyframes, loop closing with the keyframe of a place.
#pragma once

#include <optional>
#include <span>

#include "core/base/rng.h"
#include "core/geometry/camera.h"
#include "core/map/map.h"
#include "core/matching/frame_pose.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

// A view whose pose is known. Borrowed for the length of a call.
struct PosedView {
  const FeatureSet& features;
  std::span<const LandmarkId> landmarks;  // per feature; invalid where none
  Se3 world_from_camera;
};
inline PosedView posed_view(const Keyframe& keyframe) {
  return {*keyframe.features, keyframe.landmarks, keyframe.world_from_camera};
}

class DescriptorAligner {
 public:
  DescriptorAligner(const Camera& camera, const ScalePyramid& pyramid) : camera_(camera), pyramid_(pyramid) {}

  // World pose of the camera that saw `now`, with the matches that agree with it: landmarks of `there`, and its bare depth
  // readings where a feature has none. Empty where fewer than `min_inliers` agree or they do not hold all six directions.
  // `rng` draws the hypotheses. Cost: a few ms for 1,000 features on either side, most of it the matching.
  std::optional<MatchedPose> align(const Map& map, const PosedView& there, const FeatureSet& now,
                                   int min_inliers, Rng rng) const;

 private:
  std::vector<Correspondence> match(const Map& map, const PosedView& there, const FeatureSet& now) const;

  Camera camera_;
  ScalePyramid pyramid_;
};

}  // namespace vsgraphs
