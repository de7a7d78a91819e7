// The first matches of a frame: what the last one showed, landmarks and bare depth readings, is looked for where the motion
// model puts it (Mur-Artal, Tardos, ORB-SLAM2, T-RO 2017, section III-D); where that finds little, by descriptors alone.
#pragma once

#include <optional>
#include <vector>

#include "core/base/trace.h"
#include "core/matching/local_map.h"
#include "core/tracking/frame_step.h"
#include "core/tracking/recovery.h"
#include "core/tracking/tracker_options.h"

namespace vsgraphs {

struct FirstPose {
  MatchedPose found;
  bool guessed = false;  // found without prediction: to be checked against surfaces
};

class LastFrameMatcher {
 public:
  // `recovery` is borrowed for good.
  LastFrameMatcher(const TrackerOptions& options, const Camera& camera, const ScalePyramid& pyramid,
                   const Recovery& recovery)
      : options_(options), camera_(camera), pyramid_(pyramid), recovery_(recovery) {}

  // World pose and matches of step.now, the pose that explains most matches; empty where none is found. Spans `match_motion`
  // and `recover`. About 0.3 ms where the prediction holds, a few ms more where it does not.
  std::optional<FirstPose> match(const FrameStep& step, TraceSink* trace);

 private:
  struct Search {
    std::optional<MatchedPose> found;
    double explained = 0;  // share of the matches that the pose explains
  };
  Search search(const FrameStep& step, double radius_px);
  void add_matches(const FrameStep& step, double radius_px, bool landmarks, FrameMatches& matches);
  bool project(const FrameStep& step, const Se3& camera_from_world, int feature, bool landmarks,
               double radius_px, LandmarkView& view) const;

  TrackerOptions options_;
  Camera camera_;
  ScalePyramid pyramid_;
  const Recovery& recovery_;
  // Kept between calls for their memory.
  std::vector<LandmarkView> views_;
  std::vector<ProjectedPoint> projections_;
};

}  // namespace vsgraphs
