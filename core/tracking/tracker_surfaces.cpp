// The part of the tracker that works with surfaces: see depth_alignment.h.
#include "core/matching/free_space_check.h"
#include "core/tracking/tracker.h"

namespace vsgraphs {

// What constant velocity is worth: it fails by accelerations, which grow with the time between frames.
PosePriorTerm Tracker::motion_prior(const Se3& predicted, double seconds) const {
  const double sigma_m = 0.02 + 0.3 * seconds, sigma_rad = 0.02 + 0.3 * seconds;
  PosePriorTerm prior;
  prior.world_from_camera = predicted;
  prior.information.diagonal().head<3>().setConstant(1.0 / (sigma_m * sigma_m));
  prior.information.diagonal().tail<3>().setConstant(1.0 / (sigma_rad * sigma_rad));
  return prior;
}

// Whose surfaces the frame sees most of: the last frame's, its keyframe's, the local map's or the newest keyframes'
// (ties: the first of these, but for the last frame, which gives way to a keyframe that shows nearly as much: errors
// against the same reference do not add up).
SurfaceReference Tracker::choose_surface(const Map& map, const Se3& world_from_camera) {
  constexpr std::uint32_t newest = 4;
  constexpr double last_frame_handicap = 0.7;
  SurfaceReference best{last_->pose.keyframe, *last_world_, last_->surface.get()};
  double most = last_frame_handicap * aligner_.judge(surface_now(), best, world_from_camera).associated;
  std::vector<KeyframeId> candidates{last_->pose.keyframe, local_map_.reference()};
  const std::uint32_t bound = map.keyframes().index_bound();
  for (std::uint32_t back = 1; back <= std::min(bound, newest); ++back) {
    candidates.push_back(map.keyframes().at_index(bound - back));
  }
  for (const KeyframeId id : candidates) {
    const Keyframe* keyframe = map.keyframes().find(id);
    if (!keyframe || !keyframe->surface) continue;
    const SurfaceReference candidate{id, keyframe->world_from_camera, keyframe->surface.get()};
    const int associated = aligner_.judge(surface_now(), candidate, world_from_camera).associated;
    if (associated <= most) continue;
    most = associated;
    best = candidate;
  }
  return best;
}

std::optional<FramePose> Tracker::align_surfaces(const Map& map, const std::optional<FramePose>& pose,
                                                 double seconds) {
  const Se3 guess = pose ? pose->world_from_camera : predicted_;
  const SurfaceReference reference = choose_surface(map, guess);
  const PosePriorTerm prior = motion_prior(predicted_, seconds);
  if (!pose) {
    // The last frame stands nearest: where a keyframe's surfaces cannot be brought to agree, its still may.
    const SurfaceReference last{last_->pose.keyframe, *last_world_, last_->surface.get()};
    for (const SurfaceReference& candidate : {reference, last}) {
      if (const auto held = find_by_surfaces(map, candidate, prior, seconds)) return held;
    }
    return std::nullopt;
  }
  const FrameMatches matches = matches_;
  const auto held = hold_by_surfaces(map, reference, guess, prior, seconds);
  if (held) return held;
  matches_ = matches;
  // Many matches stand by themselves: on leaving a room the reference's surfaces are mostly other ones than those in view.
  if (pose->inliers >= options_.enough_inliers) return pose;
  // A few matches that the surfaces contradict are a coincidence.
  const DepthAlignment judged = aligner_.judge(surface_now(), reference, guess);
  return judged.contradicts() ? std::nullopt : pose;
}

// Surfaces alone bring the camera near; then the landmarks around can be looked for.
std::optional<FramePose> Tracker::find_by_surfaces(const Map& map, const SurfaceReference& reference,
                                                   const PosePriorTerm& prior, double seconds) {
  DepthAlignment first = aligner_.align(map, surface_now(), reference, predicted_, {}, prior);
  if (!first.convincing()) first = aligner_.align(Map{}, surface_now(), reference, predicted_, {}, prior);
  if (!first.convincing()) return std::nullopt;
  matches_.reset(now_.features->size());
  local_map_.select(map, {}, reference.id, options_.local_keyframes);
  match_local_map(map, first.solution.world_from_camera, options_.local_search_radius_px);
  return hold_by_surfaces(map, reference, first.solution.world_from_camera, prior, seconds);
}

std::optional<FramePose> Tracker::hold_by_surfaces(const Map& map, const SurfaceReference& reference,
                                                   const Se3& guess, const PosePriorTerm& prior,
                                                   double seconds) {
  // One or two matches nothing speaks for: a wrong one would move the camera wherever surfaces do not hold it.
  constexpr int corroborating_matches = 3;
  if (matches_.size() < corroborating_matches) matches_.reset(now_.features->size());
  const auto observations = pose_observations(camera_, pyramid_, *now_.features, matches_);
  DepthAlignment aligned = aligner_.align(map, surface_now(), reference, guess, observations, prior);
  // A mapped plane may be off, or another one than it seems after a large step: then the reference's depth decides alone.
  if (!aligned.convincing() || !believable(aligned.solution.world_from_camera, seconds))
    aligned = aligner_.align(Map{}, surface_now(), reference, guess, observations, prior);
  const Se3& pose = aligned.solution.world_from_camera;
  if (!aligned.convincing() || !believable(pose, seconds)) return std::nullopt;
  std::vector<std::uint8_t> inlier(observations.size());
  for (std::size_t i = 0; i < inlier.size(); ++i) inlier[i] = is_inlier(aligned.solution.fit[i]);
  matches_.keep(inlier);
  if (!observations.empty() && matches_.size() < corroborating_matches)
    return hold_by_surfaces(map, reference, guess, prior, seconds);
  now_.surface_reference = reference.id;
  return FramePose{pose,
                   matches_.size(),
                   true,
                   aligned.surface_information,
                   aligned.solution.information,
                   aligned.solution.degenerate};
}

bool Tracker::surfaces_agree(const Map& map, const FramePose& pose) {
  constexpr int enough_samples = 150;
  const Keyframe* keyframe = map.keyframes().find(local_map_.reference());
  if (!keyframe || !keyframe->surface) return true;
  const DepthAlignment judged = aligner_.judge(
      surface_now(), {local_map_.reference(), keyframe->world_from_camera, keyframe->surface.get()},
      pose.world_from_camera);
  if (judged.associated >= enough_samples) return !judged.contradicts();
  // Too little common surface to tell: then the matches must tell by their number.
  return pose.inliers >= 2 * options_.recovery.min_relocalisation_inliers;
}

bool Tracker::leaps(const FramePose& pose) const {
  constexpr double far_rad = 0.2;
  return rotation_angle((last_world_->inverse() * pose.world_from_camera).rotation()) > far_rad;
}

// The other way round, what stands now where keyframes looked through may have come since: people do.
bool Tracker::leaves_surfaces_standing(const Map& map, const FramePose& pose) const {
  // Those around alone: what was seen on another visit may have drifted away from them.
  const FreeSpaceCount count =
      count_seen_through(map, aligner_.sampler(), camera_.depth_noise, local_map_.keyframes(), surface_now(),
                         pose.world_from_camera);
  return count.through <= options_.recovery.max_seen_through_share * count.seen;
}

}  // namespace vsgraphs
