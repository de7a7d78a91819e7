// A frame against the local map: landmarks of the keyframes that see what it sees are looked for around a pose, and the pose
// is solved again with all that is found (PTAM and ORB-SLAM; Mur-Artal, Montiel, Tardos, T-RO 2015, section V-D). The map
// holds a pose better than the last frame does: errors do not add up.
#pragma once

#include <optional>
#include <vector>

#include "core/matching/local_map.h"
#include "core/tracking/frame_state.h"
#include "core/tracking/tracker_options.h"

namespace vsgraphs {

class LocalMapMatcher {
 public:
  LocalMapMatcher(const TrackerOptions& options, const Camera& camera, const ScalePyramid& pyramid)
      : options_(options), camera_(camera), pyramid_(pyramid) {}

  // Votes for a local map with the guess's matches (`near` where they cast none), adds matches within `radius_px` (level 0)
  // of where the guess sees its landmarks, solves with those and the planes of the map. Empty where too few matches agree.
  // World pose. About 0.6 ms.
  std::optional<MatchedPose> refine(const Map& map, const FrameState& now, MatchedPose guess, KeyframeId near,
                                    double radius_px);

  // Landmarks of the local map around one keyframe, looked for from a pose; nothing is solved.
  FrameMatches match_around(const Map& map, const FrameState& now, KeyframeId near,
                            const Se3& world_from_camera);

  // Of the last refine() or match_around(), be it of an earlier frame: its keyframes, and the landmarks that should have
  // been in view, matched or not.
  const LocalMap& local_map() const { return local_map_; }
  const std::vector<LandmarkId>& expected() const { return expected_; }

 private:
  void add_matches(const Map& map, const FrameState& now, const Se3& world_from_camera, double radius_px,
                   FrameMatches& matches);
  void project(const Map& map, const Se3& world_from_camera, double radius_px, const FrameMatches& matches);

  TrackerOptions options_;
  Camera camera_;
  ScalePyramid pyramid_;
  LocalMap local_map_;
  std::vector<LandmarkId> expected_;
  // Of those in view that are not matched yet.
  std::vector<LandmarkView> views_;
  std::vector<ProjectedPoint> projections_;
};

}  // namespace vsgraphs
