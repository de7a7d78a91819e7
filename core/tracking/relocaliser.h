// Where a lost camera is found again. Whatever might be the place is tried to the end: the last frame's surroundings first,
// then what looks most alike (vision/place_index.h), in the map the camera was lost in, the active one and the others.
#pragma once

#include <optional>

#include "core/matching/messages.h"
#include "core/tracking/last_frame.h"
#include "core/tracking/local_map_matcher.h"
#include "core/tracking/pose_verifier.h"
#include "core/tracking/recovery.h"

namespace vsgraphs {

struct Relocalisation {
  const KnownMap* in = nullptr;
  MatchedPose found;  // in the world of that map
};

class Relocaliser {
 public:
  // `recovery`, `verifier` and `local_map` are borrowed for good.
  Relocaliser(const TrackerOptions& options, const Recovery& recovery, const PoseVerifier& verifier,
              LocalMapMatcher& local_map)
      : options_(options), recovery_(recovery), verifier_(verifier), local_map_(local_map) {}

  // `last_in`: the one of `known` that holds the last frame, or null. Empty where nothing is recognised. A few ms for each
  // place tried.
  std::optional<Relocalisation> search(const KnownMaps& known, const KnownMap* last_in, const LastFrame& last,
                                       const FrameState& now);

 private:
  std::optional<MatchedPose> near_last_frame(const Map& map, const LastFrame& last, const FrameState& now);
  std::optional<MatchedPose> by_look(const KnownMap& known, const LastFrame* last_here,
                                     const FrameState& now);
  std::optional<MatchedPose> search_around(const Map& map, std::optional<MatchedPose> guess, KeyframeId near,
                                           int min_inliers, const FrameState& now);
  bool in_reach(const LastFrame& last, const FrameState& now, const MatchedPose& found) const;

  TrackerOptions options_;
  const Recovery& recovery_;
  const PoseVerifier& verifier_;
  LocalMapMatcher& local_map_;
};

}  // namespace vsgraphs
