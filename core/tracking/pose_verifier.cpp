#include "core/tracking/pose_verifier.h"

#include "core/matching/free_space_check.h"

namespace vsgraphs {

namespace {

// Turned so far that the same poster in another room would be in view where the prediction looks for it.
bool leaps(const Se3& world_from_last, const Se3& world_from_camera) {
  constexpr double far_rad = 0.2;
  return rotation_angle((world_from_last.inverse() * world_from_camera).rotation()) > far_rad;
}

}  // namespace

bool PoseVerifier::follows(const FrameStep& step, const LocalMap& local_map, const FramePose& pose,
                           bool guessed) const {
  const Se3& at = pose.world_from_camera;
  if (guessed && !surfaces_agree(step.map, local_map, *step.now.surface, pose)) return false;
  if (leaps(step.last.world_from_camera(), at) &&
      !leaves_surfaces_standing(step.map, local_map, *step.now.surface, at))
    return false;
  return step.gate.passes(at);
}

bool PoseVerifier::fits(const Map& map, const LocalMap& local_map, const DepthGrid& surface,
                        const FramePose& pose) const {
  return surfaces_agree(map, local_map, surface, pose) &&
         leaves_surfaces_standing(map, local_map, surface, pose.world_from_camera);
}

// Do the frame's surfaces lie where the keyframe that shares most landmarks saw them?
bool PoseVerifier::surfaces_agree(const Map& map, const LocalMap& local_map, const DepthGrid& surface,
                                  const FramePose& pose) const {
  constexpr int enough_samples = 150;
  const KeyframeId reference = local_map.reference();
  const Keyframe* keyframe = map.keyframes().find(reference);
  if (!keyframe || !keyframe->surface) return true;
  const DepthAlignment judged = aligner_.judge(
      surface, {reference, keyframe->world_from_camera, keyframe->surface.get()}, pose.world_from_camera);
  if (judged.associated >= enough_samples) return !judged.contradicts();
  // Too little common surface to tell: then the matches must tell by their number.
  return pose.inliers >= 2 * options_.min_relocalisation_inliers;
}

// Does the frame look through walls that any keyframe around saw? The other way round, what stands now where keyframes
// looked through may have come since: people do. Those around alone: what was seen on another visit may have drifted.
bool PoseVerifier::leaves_surfaces_standing(const Map& map, const LocalMap& local_map,
                                            const DepthGrid& surface, const Se3& world_from_camera) const {
  const FreeSpaceCount count = count_seen_through(map, aligner_.sampler(), camera_.depth_noise,
                                                  local_map.keyframes(), surface, world_from_camera);
  return count.through <= options_.max_seen_through_share * count.seen;
}

}  // namespace vsgraphs
