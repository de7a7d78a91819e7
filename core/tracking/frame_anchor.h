// Where a frame hangs: on the keyframe that held its pose, so that corrections of the keyframe move it for free.
#pragma once

#include "core/map/map.h"
#include "core/matching/local_map.h"
#include "core/tracking/frame_state.h"

namespace vsgraphs {

// The keyframe whose surfaces held the pose, else the one with most votes of the landmarks matched, else `near`: a handful
// of votes is no hold, and may come from a place that only looks alike.
KeyframeId choose_anchor(const LocalMap& local_map, const MatchedPose& found, KeyframeId near);

// Writes what was found into `now`: landmarks, whose surfaces, and the pose relative to `anchor`, a keyframe of `map`.
void anchor_frame(const Map& map, KeyframeId anchor, const MatchedPose& found, FrameState& now);

// What ties an anchored frame to its anchor where less than `few` landmarks do, and empty elsewhere. `information` is that of the
// frame's pose, tangent on its right.
std::optional<TrackedLink> link_to_anchor(const FrameState& now, const Matrix6d& information, int few);

}  // namespace vsgraphs
