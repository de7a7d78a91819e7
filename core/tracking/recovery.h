// Finding the pose where prediction failed: by descriptors alone (matching/descriptor_alignment.h), against the last frame
// and its reference keyframe after a large step, or against any keyframe after a loss.
#pragma once

#include <optional>
#include <vector>

#include "core/base/options.h"
#include "core/map/map.h"
#include "core/matching/descriptor_alignment.h"
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
  field("min_inliers", o.min_inliers, 10, 500,
        "least number of matches that a pose found after a large step must explain");
  field("min_aligned", o.min_aligned, 10, 500,
        "least number of matches by descriptor with one keyframe that a pose after tracking was lost must "
        "explain");
  field("min_relocalisation_inliers", o.min_relocalisation_inliers, 10, 500,
        "least number of landmarks found around a pose near the last one, after tracking was lost");
  field("min_place_inliers", o.min_place_inliers, 10, 1000,
        "least number of landmarks found around a pose that appearance alone recognised; twice as many in "
        "another map");
  field("max_candidates", o.max_candidates, 1, 50,
        "number of keyframes of each map that a lost frame is compared with");
  field("max_seen_through_share", o.max_seen_through_share, 0.0, 1.0,
        "largest share of the map's visible surfaces that a recognised frame may look through");
}

class Recovery {
 public:
  Recovery(const RecoveryOptions& options, const Camera& camera, const ScalePyramid& pyramid,
           std::uint64_t seed)
      : options_(options), aligner_(camera, pyramid), seed_(seed) {}

  // Against the last frame (its landmarks and depth) and a keyframe; the better one wins. Cost: a few ms.
  std::optional<MatchedPose> from_recent(const Map& map, const FeatureSet& now, std::int64_t frame_index,
                                         const PosedView& last, KeyframeId keyframe) const;

  // The keyframes to try for a frame, at most `max_candidates`: up to half of them from `last_room` (where it is one),
  // tried first, then those that look most alike anywhere; each group best first. 2 to 3 ms for 2,000 keyframes.
  std::vector<KeyframeId> likely_places(const KnownMap& known, const FeatureSet& now,
                                        RoomNumber last_room) const;
  // Against one of them. Cost: a few ms.
  std::optional<MatchedPose> from_keyframe(const Map& map, KeyframeId keyframe, const FeatureSet& now,
                                           std::int64_t frame_index) const;

 private:
  Rng draws(std::int64_t frame_index) const;

  RecoveryOptions options_;
  DescriptorAligner aligner_;
  std::uint64_t seed_;
};

}  // namespace vsgraphs
