// The pose of a camera from matched points without a prediction: RANSAC (Fischler and Bolles 1981) over three matches with
// depth (align_points, then two Gauss-Newton steps that make it as sharp as the pixels are), counted in the image, then the
// pose solver on what agrees. For relocalisation, large steps and loops.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/base/rng.h"
#include "core/solve/pose_solver.h"

namespace vsgraphs {

struct AlignMatchesOptions {
  int max_hypotheses = 300;
  double confidence = 0.999;  // stop once a better hypothesis would have been drawn with this probability
  int min_inliers = 12;       // fewer after refinement: no result
  // RANSAC's gate in sigmas^2 over the 95 % quantile: a pose from three points is itself uncertain.
  double gate_inflation = 4.0;
};

// `matches`: those with depth are drawn from; those without are counted and refined with. The solution's `fit` is in the
// order of `matches`. Deterministic in `rng`. Cost about 4 ns per match and hypothesis.
std::optional<PoseSolution> align_matches(const Intrinsics& intrinsics,
                                          std::span<const PoseObservation> matches, Rng rng,
                                          const AlignMatchesOptions& options = {});

}  // namespace vsgraphs
