#include "core/tracking/surface_tracker.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/tracking/motion_prior.h"

namespace vsgraphs {

namespace {

SurfaceReference surfaces_of(const LastFrame& last) {
  return {last.state().pose.keyframe, last.world_from_camera(), last.state().surface.get()};
}

}  // namespace

std::optional<MatchedPose> SurfaceTracker::align(const FrameStep& step,
                                                 const std::optional<MatchedPose>& found) {
  const Se3 guess = found ? found->pose.world_from_camera : step.predicted;
  const SurfaceReference reference = choose(step, guess);
  if (!found) {
    // The last frame stands nearest: where a keyframe's surfaces cannot be brought to agree, its still may.
    for (const SurfaceReference& candidate : {reference, surfaces_of(step.last)}) {
      if (auto held = find(step, candidate)) return held;
    }
    return std::nullopt;
  }
  if (auto held = hold(step, reference, guess, found->matches)) return held;
  // Many matches stand by themselves: on leaving a room the reference's surfaces are mostly other ones than those in view.
  if (found->pose.inliers >= options_.enough_inliers) return found;
  // A few matches that the surfaces contradict are a coincidence.
  const DepthAlignment judged = aligner_.judge(*step.now.surface, reference, guess);
  return judged.contradicts() ? std::nullopt : found;
}

// Whose surfaces the frame sees most of: the last frame's, its keyframe's, the local map's or the newest keyframes'
// (ties: the first of these, but for the last frame, which gives way to a keyframe that shows nearly as much: errors
// against the same reference do not add up).
SurfaceReference SurfaceTracker::choose(const FrameStep& step, const Se3& world_from_camera) const {
  constexpr std::uint32_t newest = 4;
  constexpr double last_frame_handicap = 0.7;
  const Map::Keyframes& keyframes = step.map.keyframes();
  SurfaceReference best = surfaces_of(step.last);
  double most = last_frame_handicap * aligner_.judge(*step.now.surface, best, world_from_camera).associated;
  std::vector<KeyframeId> candidates{best.id, local_map_.local_map().reference()};
  const std::uint32_t bound = keyframes.index_bound();
  for (std::uint32_t back = 1; back <= std::min(bound, newest); ++back)
    candidates.push_back(keyframes.at_index(bound - back));
  for (const KeyframeId id : candidates) {
    const Keyframe* keyframe = keyframes.find(id);
    if (!keyframe || !keyframe->surface) continue;
    const SurfaceReference candidate{id, keyframe->world_from_camera, keyframe->surface.get()};
    const int associated = aligner_.judge(*step.now.surface, candidate, world_from_camera).associated;
    if (associated <= most) continue;
    most = associated;
    best = candidate;
  }
  return best;
}

// Surfaces alone bring the camera near; then the landmarks around can be looked for.
std::optional<MatchedPose> SurfaceTracker::find(const FrameStep& step, const SurfaceReference& reference) {
  const PosePriorTerm prior = motion_prior(step.predicted, step.seconds);
  DepthAlignment first = aligner_.align(step.map, *step.now.surface, reference, step.predicted, {}, prior);
  if (!first.convincing())
    first = aligner_.align(Map{}, *step.now.surface, reference, step.predicted, {}, prior);
  if (!first.convincing()) return std::nullopt;
  const Se3& near = first.solution.world_from_camera;
  return hold(step, reference, near, local_map_.match_around(step.map, step.now, reference.id, near));
}

std::optional<MatchedPose> SurfaceTracker::hold(const FrameStep& step, const SurfaceReference& reference,
                                                const Se3& guess, FrameMatches matches) const {
  // One or two matches nothing speaks for: a wrong one would move the camera wherever surfaces do not hold it.
  constexpr int corroborating_matches = 3;
  if (matches.size() < corroborating_matches) matches.reset(step.now.features->size());
  const auto observations = pose_observations(camera_, pyramid_, *step.now.features, matches);
  const PosePriorTerm prior = motion_prior(step.predicted, step.seconds);
  const auto good = [&step](const DepthAlignment& aligned) {
    return aligned.convincing() && step.gate.passes(aligned.solution.world_from_camera);
  };
  DepthAlignment aligned = aligner_.align(step.map, *step.now.surface, reference, guess, observations, prior);
  // A mapped plane may be off, or another one than it seems after a large step: then the reference's depth decides alone.
  if (!good(aligned))
    aligned = aligner_.align(Map{}, *step.now.surface, reference, guess, observations, prior);
  if (!good(aligned)) return std::nullopt;
  const PoseSolution& solution = aligned.solution;
  matches.keep_inliers(solution.fit);
  if (!observations.empty() && matches.size() < corroborating_matches)
    return hold(step, reference, guess, std::move(matches));
  const FramePose pose{solution.world_from_camera,  matches.size(),       true,
                       aligned.surface_information, solution.information, solution.degenerate};
  return MatchedPose{pose, std::move(matches), reference.id};
}

}  // namespace vsgraphs
