// Finding the pose where prediction failed: features are matched by descriptor alone, against the last frame and
// its reference keyframe after a large step, or against any keyframe after a loss. The pose comes from a RANSAC
// over matches with depth on both sides or one, and is then solved like any other.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/map/map.h"
#include "core/matching/frame_pose.h"
#include "core/matching/messages.h"

namespace vsgraphs {

struct RecoveryOptions {
  int min_inliers = 25;
  int min_aligned = 15;
  int min_relocalisation_inliers = 40;
  int min_place_inliers = 100;
  int max_candidates = 5;
  double max_seen_through_share = 0.03;
};

template <typename Visitor>
void describe(RecoveryOptions& o, Visitor& field) {
  field("min_inliers", o.min_inliers, 10, 500, "matches a pose found after a large step must explain");
  field("min_aligned", o.min_aligned, 10, 500,
        "matches by look with one keyframe that a pose after a loss must explain, to be searched around");
  field("min_relocalisation_inliers", o.min_relocalisation_inliers, 10, 500,
        "landmarks that must be found around a pose near the last one, after a loss");
  field("min_place_inliers", o.min_place_inliers, 10, 1000,
        "landmarks that must be found around a pose recognised by its look alone: a poster is not enough; "
        "twice as many in "
        "a map the camera was not in before");
  field("max_candidates", o.max_candidates, 1, 50, "keyframes of a map tried per frame after a loss");
  field("max_seen_through_share", o.max_seen_through_share, 0.0, 1.0,
        "share of the map's surfaces in view that a frame may look through where it was found after a loss");
}

class Recovery {
 public:
  Recovery(const RecoveryOptions& options, const Camera& camera, const ScalePyramid& pyramid,
           std::uint64_t seed)
      : options_(options), camera_(camera), pyramid_(pyramid), seed_(seed) {}

  // Against the last frame (its landmarks and depth) and a keyframe; the better one wins. Fills `matches`.
  std::optional<FramePose> from_recent(const Map& map, const FeatureSet& now, std::int64_t frame_index,
                                       const FeatureSet& last, std::span<const LandmarkId> last_landmarks,
                                       const Se3& world_from_last, KeyframeId keyframe,
                                       FrameMatches& matches);

  // The keyframes to try for a frame, at most `max_candidates`: up to half of them from `last_room` (where it is one),
  // tried first, then those that look most alike anywhere; each group best first. 2 to 3 ms for 2,000 keyframes.
  std::vector<KeyframeId> likely_places(const KnownMap& known, const FeatureSet& now,
                                        RoomNumber last_room) const;
  // Against one of them. Fills `matches`. Cost: a few ms.
  std::optional<FramePose> from_keyframe(const Map& map, KeyframeId keyframe, const FeatureSet& now,
                                         std::int64_t frame_index, FrameMatches& matches) const;

 private:
  struct Source {
    const FeatureSet* features;
    std::span<const LandmarkId> landmarks;
    Se3 world_from_camera;
  };
  std::optional<FramePose> align(const Map& map, const Source& source, const FeatureSet& now,
                                 std::int64_t frame_index, int min_inliers, FrameMatches& matches) const;

  RecoveryOptions options_;
  Camera camera_;
  ScalePyramid pyramid_;
  std::uint64_t seed_;
};

}  // namespace vsgraphs
