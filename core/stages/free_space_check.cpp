#include "core/stages/free_space_check.h"

#include "core/vision/depth_sampling.h"

namespace vsgraphs {

FreeSpaceCount count_seen_through(const Camera& camera, const DepthGrid& source, const DepthGrid& witness,
                                  const Se3& witness_from_source, double tolerance_m) {
  const DepthSampler sampler(camera);
  FreeSpaceCount count;
  for (const SurfaceSample& sample : source.samples) {
    if (!sample.has_normal()) continue;  // rims are where readings mislead
    const Eigen::Vector3d p = witness_from_source * sample.point.cast<double>();
    const SurfaceSample* there = p.z() > 0 ? sampler.look_up(witness, p) : nullptr;
    if (!there || !there->has_normal()) continue;
    const auto there_m = static_cast<double>(there->point.z());
    const double behind_m = there_m - p.z();
    const double margin_m = tolerance_m + 4.0 * camera.depth_noise.sigma_m(there_m);
    if (behind_m < -margin_m) continue;  // hidden behind what the witness saw
    ++count.seen;
    count.through += behind_m > margin_m;
  }
  return count;
}

FreeSpaceCount count_seen_through(const Map& map, const Camera& camera, const std::vector<KeyframeId>& from,
                                  const Se3& correction, const std::vector<KeyframeId>& to,
                                  const Slack& slack) {
  FreeSpaceCount count;
  for (const KeyframeId seer : from) {
    const Keyframe& source = *map.keyframes().find(seer);
    if (!source.surface) continue;
    for (const KeyframeId witness : to) {
      const Keyframe& target = *map.keyframes().find(witness);
      if (!target.surface) continue;
      const double away_m = (target.world_from_camera.translation() - slack.centre).norm();
      count += count_seen_through(camera, *source.surface, *target.surface,
                                  target.world_from_camera.inverse() * correction * source.world_from_camera,
                                  slack.least_m + slack.share * away_m);
    }
  }
  return count;
}

FreeSpaceCount count_seen_through(const Map& map, const Camera& camera, const DepthGrid& frame,
                                  const Se3& world_from_frame, double reach_m) {
  FreeSpaceCount count;
  map.keyframes().for_each([&](KeyframeId, const Keyframe& keyframe) {
    const Se3 frame_from_keyframe = world_from_frame.inverse() * keyframe.world_from_camera;
    if (!keyframe.surface || frame_from_keyframe.translation().norm() > reach_m) return;
    count += count_seen_through(camera, *keyframe.surface, frame, frame_from_keyframe, Slack{}.least_m);
  });
  return count;
}

}  // namespace vsgraphs
