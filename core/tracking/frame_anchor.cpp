#include "core/tracking/frame_anchor.h"

namespace vsgraphs {

KeyframeId choose_anchor(const LocalMap& local_map, const MatchedPose& found, KeyframeId near) {
  constexpr int enough_votes = 15;
  if (found.surface_reference.valid()) return found.surface_reference;
  if (local_map.reference_votes() >= enough_votes) return local_map.reference();
  return near;
}

void anchor_frame(const Map& map, KeyframeId anchor, const MatchedPose& found, FrameState& now) {
  now.adopt(found.matches);
  now.surface_reference = found.surface_reference;
  const Se3& world_from_anchor = map.keyframes().find(anchor)->world_from_camera;
  now.pose = {anchor, world_from_anchor.inverse() * found.pose.world_from_camera};
}

std::optional<TrackedLink> link_to_anchor(const FrameState& now, const Matrix6d& information, int few) {
  if (now.matched_landmarks() >= few) return std::nullopt;
  return TrackedLink{now.pose.keyframe, now.pose.keyframe_from_camera, information};
}

}  // namespace vsgraphs
