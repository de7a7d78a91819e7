#include "core/loops/odometry_trust.h"

#include <algorithm>
#include <numbers>
#include <span>

#include "core/geometry/pose_covariance.h"

namespace vsgraphs {

namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;

// Keyframes each of which has a step that begins at the one before it; the first one's own step is not part of it.
using Chain = std::vector<KeyframeId>;

std::vector<Chain> chains_of(const Map& map) {
  std::vector<Chain> chains;
  std::vector<int> chain_of(map.keyframes().index_bound(), -1);
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    const KeyframeId before = keyframe.odometry ? keyframe.odometry->before : KeyframeId{};
    int& chain = chain_of[id.index];
    chain = before.valid() ? chain_of[before.index] : -1;
    if (chain < 0) {
      chain = static_cast<int>(chains.size());
      chains.emplace_back();
    }
    chains[static_cast<std::size_t>(chain)].push_back(id);
  });
  return chains;
}

// From the first to the last of a run.
bool contradicted(const Map& map, const DriftOptions& options, std::span<const KeyframeId> run) {
  Se3 measured;
  Matrix6d covariance = Matrix6d::Zero();
  double way_m = 0, turn_rad = 0;
  for (const KeyframeId id : run.subspan(1)) {
    const OdometryStep& step = *map.keyframes().find(id)->odometry;
    covariance = compose_covariance(
        covariance, step.before_from_camera,
        step.covariance + isotropic_covariance(options.step_m, options.step_deg * rad_per_deg));
    measured = measured * step.before_from_camera;
    way_m += step.before_from_camera.translation().norm();
    turn_rad += rotation_angle(step.before_from_camera.rotation());
  }
  covariance +=
      isotropic_covariance(options.share_of_way * way_m,
                           options.turn_deg_per_m * rad_per_deg * way_m + options.share_of_turn * turn_rad);
  const auto pose = [&map](KeyframeId id) { return map.keyframes().find(id)->world_from_camera; };
  const Se3 mapped = pose(run.front()).inverse() * pose(run.back());
  return sigmas_of((measured.normalized().inverse() * mapped).log(), covariance) > contradiction_sigmas;
}

}  // namespace

std::vector<std::uint8_t> contradicted_steps(const Map& map, const DriftOptions& options) {
  std::vector<std::uint8_t> result(map.keyframes().index_bound(), 0);
  for (const Chain& chain : chains_of(map)) {
    for (const int length : {short_run, longest_run}) {
      const std::size_t steps = std::min(static_cast<std::size_t>(length), chain.size() - 1);
      for (std::size_t first = 0; steps > 0 && first + steps < chain.size(); ++first) {
        const auto run = std::span(chain).subspan(first, steps + 1);
        if (!contradicted(map, options, run)) continue;
        for (const KeyframeId id : run.subspan(1)) result[id.index] = 1;
      }
    }
  }
  return result;
}

}  // namespace vsgraphs
