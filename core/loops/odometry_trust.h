// Where the map's poses cannot be what odometry measured: some correction bent it there. The map is the better of the two as long
// as they agree, for it weighs all that was seen; where they do not, only odometry knows nothing of the correction.
#pragma once

#include <cstdint>
#include <vector>

#include "core/loops/loop_graph.h"

namespace vsgraphs {

// By keyframe index: 1 where the step to this keyframe belongs to a run, of 5 or 20 steps or all there are, whose ends the map
// has farther from where odometry has them than the drift of such a way allows, by more than `contradiction_sigmas`. On simulated
// plans without a false loop no run is off by more than 4.3; single steps, which a wrong match can spoil, are by up to 5.1.
// Cost: linear in the keyframes, 25 products of covariances each.
inline constexpr double contradiction_sigmas = 5.0;
inline constexpr int short_run = 5, longest_run = 20;
std::vector<std::uint8_t> contradicted_steps(const Map& map, const DriftOptions& options);

}  // namespace vsgraphs
