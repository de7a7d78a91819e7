// A pose held by surfaces where landmarks are too few to tell it (depth_alignment.h): whose surfaces to lay the frame
// against, with which matches and which planes, and what to believe where surfaces and matches contradict one another.
#pragma once

#include <optional>

#include "core/tracking/depth_alignment.h"
#include "core/tracking/frame_step.h"
#include "core/tracking/local_map_matcher.h"

namespace vsgraphs {

class SurfaceTracker {
 public:
  // `aligner` and `local_map` are borrowed for good.
  SurfaceTracker(const TrackerOptions& options, const Camera& camera, const ScalePyramid& pyramid,
                 const DepthAligner& aligner, LocalMapMatcher& local_map)
      : options_(options), camera_(camera), pyramid_(pyramid), aligner_(aligner), local_map_(local_map) {}

  // `found`: what matches say of step.now; empty if nothing. Returns the pose held by surfaces (its surface_reference is
  // valid), `found` as it was where surfaces do not hold, or nothing where they contradict a few matches. World pose.
  // 1 to 3 ms.
  std::optional<MatchedPose> align(const FrameStep& step, const std::optional<MatchedPose>& found);

 private:
  SurfaceReference choose(const FrameStep& step, const Se3& world_from_camera) const;
  std::optional<MatchedPose> find(const FrameStep& step, const SurfaceReference& reference);
  std::optional<MatchedPose> hold(const FrameStep& step, const SurfaceReference& reference, const Se3& guess,
                                  FrameMatches matches) const;

  TrackerOptions options_;
  Camera camera_;
  ScalePyramid pyramid_;
  const DepthAligner& aligner_;
  LocalMapMatcher& local_map_;
};

}  // namespace vsgraphs
