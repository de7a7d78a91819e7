#include "core/tracking/recovery.h"

#include <algorithm>

#include "core/base/rng.h"
#include "core/solve/align_matches.h"
#include "core/vision/matching.h"

namespace vsgraphs {

std::optional<FramePose> Recovery::from_recent(const Map& map, const FeatureSet& now,
                                               std::int64_t frame_index, const FeatureSet& last,
                                               std::span<const LandmarkId> last_landmarks,
                                               const Se3& world_from_last, KeyframeId keyframe_id,
                                               FrameMatches& matches) {
  auto best =
      align(map, {&last, last_landmarks, world_from_last}, now, frame_index, options_.min_inliers, matches);
  const Keyframe* keyframe = map.keyframes().find(keyframe_id);
  if (!keyframe) return best;
  FrameMatches other_matches;
  const auto other = align(map, {keyframe->features.get(), keyframe->landmarks, keyframe->world_from_camera},
                           now, frame_index, options_.min_inliers, other_matches);
  if (other && (!best || other->inliers > best->inliers)) {
    matches = std::move(other_matches);
    return other;
  }
  return best;
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

std::optional<FramePose> Recovery::from_keyframe(const Map& map, KeyframeId id, const FeatureSet& now,
                                                 std::int64_t frame_index, FrameMatches& matches) const {
  const Keyframe& keyframe = *map.keyframes().find(id);
  return align(map, {keyframe.features.get(), keyframe.landmarks, keyframe.world_from_camera}, now,
               frame_index, options_.min_aligned, matches);
}

std::optional<FramePose> Recovery::align(const Map& map, const Source& source, const FeatureSet& now,
                                         std::int64_t frame_index, int min_inliers,
                                         FrameMatches& matches) const {
  matches.reset(now.size());
  MatchOptions options;
  options.max_distance = 64;
  options.ratio = 0.85;
  options.check_rotation = true;
  std::vector<Correspondence> candidates;
  std::vector<PoseObservation> observations;
  for (const auto& [there, here] : match_descriptors(*source.features, now, options)) {
    const LandmarkId id = source.landmarks[static_cast<std::size_t>(there)];
    const Landmark* landmark = map.landmarks().find(id);
    const Feature& feature = (*source.features)[there];
    if (!landmark && !feature.has_depth()) continue;
    const Eigen::Vector3d point =
        landmark ? landmark->point_in_world
                 : source.world_from_camera * camera_.unproject(feature.u, feature.v, feature.depth_m);
    candidates.push_back({here, landmark ? id : LandmarkId{}, point});
    observations.push_back(pose_observation(camera_, pyramid_, now[here], point));
  }
  if (static_cast<int>(candidates.size()) < min_inliers) return std::nullopt;
  AlignMatchesOptions align_options;
  align_options.min_inliers = min_inliers;
  const auto aligned =
      align_matches(Intrinsics::of(camera_), observations,
                    Rng(seed_, "recovery", static_cast<std::uint64_t>(frame_index)), align_options);
  if (!aligned || aligned->degenerate) return std::nullopt;
  for (const Correspondence& c : candidates) matches.add(c);
  std::vector<std::uint8_t> inlier(candidates.size());
  for (std::size_t i = 0; i < inlier.size(); ++i) inlier[i] = is_inlier(aligned->fit[i]);
  matches.keep(inlier);
  return FramePose{aligned->world_from_camera, matches.size(),       true,
                   aligned->information,       aligned->information, false};
}

}  // namespace vsgraphs
