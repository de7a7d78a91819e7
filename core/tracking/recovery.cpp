#include "core/tracking/recovery.h"

#include <algorithm>

namespace vsgraphs {

Rng Recovery::draws(std::int64_t frame_index) const {
  return {seed_, "recovery", static_cast<std::uint64_t>(frame_index)};
}

std::optional<MatchedPose> Recovery::from_recent(const Map& map, const FeatureSet& now,
                                                 std::int64_t frame_index, const PosedView& last,
                                                 KeyframeId keyframe_id) const {
  auto best = aligner_.align(map, last, now, options_.min_inliers, draws(frame_index));
  const Keyframe* keyframe = map.keyframes().find(keyframe_id);
  if (!keyframe) return best;
  auto other = aligner_.align(map, posed_view(*keyframe), now, options_.min_inliers, draws(frame_index));
  const bool better = other && (!best || other->pose.inliers > best->pose.inliers);
  return better ? other : best;
}

std::vector<KeyframeId> Recovery::likely_places(const KnownMap& known, const FeatureSet& now,
                                                RoomNumber last_room) const {
  constexpr int looked_at = 60;
  const Map& map = *known.map;
  const auto limit = static_cast<std::size_t>(options_.max_candidates);
  std::vector<KeyframeId> alike;
  for (const PlaceMatch& match : known.places->query(now, looked_at)) {
    if (map.keyframes().contains(match.keyframe)) alike.push_back(match.keyframe);
  }
  std::vector<KeyframeId> likely;
  if (last_room != no_room) {
    for (const KeyframeId id : alike) {
      if (likely.size() >= (limit + 1) / 2) break;
      if (map.room_at(map.keyframes().find(id)->world_from_camera.translation()) == last_room)
        likely.push_back(id);
    }
  }
  for (const KeyframeId id : alike) {
    if (likely.size() >= limit) break;
    if (std::find(likely.begin(), likely.end(), id) == likely.end()) likely.push_back(id);
  }
  return likely;
}

std::optional<MatchedPose> Recovery::from_keyframe(const Map& map, KeyframeId id, const FeatureSet& now,
                                                   std::int64_t frame_index) const {
  return aligner_.align(map, posed_view(*map.keyframes().find(id)), now, options_.min_aligned,
                        draws(frame_index));
}

}  // namespace vsgraphs
