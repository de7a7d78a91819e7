#include "core/matching/free_space_check.h"

namespace vsgraphs {

FreeSpaceCount count_seen_through(const DepthSampler& sampler, const DepthNoise& noise,
                                  const DepthGrid& source, const DepthGrid& witness,
                                  const Se3& witness_from_source, double tolerance_m) {
  FreeSpaceCount count;
  for (const SurfaceSample& sample : source.samples) {
    if (!sample.has_normal()) continue;  // rims are where readings mislead
    const Eigen::Vector3d p = witness_from_source * sample.point.cast<double>();
    const SurfaceSample* there = p.z() > 0 ? sampler.look_up(witness, p) : nullptr;
    if (!there || !there->has_normal()) continue;
    const auto there_m = static_cast<double>(there->point.z());
    const double behind_m = there_m - p.z();
    const double margin_m = tolerance_m + 4.0 * noise.sigma_m(there_m);
    if (behind_m < -margin_m) continue;  // hidden behind what the witness saw
    ++count.seen;
    count.through += behind_m > margin_m;
  }
  return count;
}

FreeSpaceCount count_seen_through(const Map& map, const Camera& camera, const std::vector<KeyframeId>& from,
                                  const Se3& correction, const std::vector<KeyframeId>& to,
                                  const Slack& slack) {
  const DepthSampler sampler(camera);
  FreeSpaceCount count;
  for (const KeyframeId seer : from) {
    const Keyframe& source = *map.keyframes().find(seer);
    if (!source.surface) continue;
    for (const KeyframeId witness : to) {
      const Keyframe& target = *map.keyframes().find(witness);
      if (!target.surface) continue;
      const double away_m = (target.world_from_camera.translation() - slack.centre).norm();
      count += count_seen_through(sampler, camera.depth_noise, *source.surface, *target.surface,
                                  target.world_from_camera.inverse() * correction * source.world_from_camera,
                                  slack.least_m + slack.share * away_m);
    }
  }
  return count;
}

FreeSpaceCount count_seen_through(const Map& map, const DepthSampler& sampler, const DepthNoise& noise,
                                  const std::vector<KeyframeId>& from, const DepthGrid& frame,
                                  const Se3& world_from_frame) {
  FreeSpaceCount count;
  for (const KeyframeId id : from) {
    const Keyframe& keyframe = *map.keyframes().find(id);
    if (!keyframe.surface) continue;
    count += count_seen_through(sampler, noise, *keyframe.surface, frame,
                                world_from_frame.inverse() * keyframe.world_from_camera, Slack{}.least_m);
  }
  return count;
}

}  // namespace vsgraphs
