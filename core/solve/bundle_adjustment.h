// The joint problem: keyframe poses, landmarks and structure in one Levenberg-Marquardt (Marquardt 1963; damping after
// Nielsen 1999), landmarks eliminated by the Schur complement (Triggs et al., "Bundle Adjustment - A Modern Synthesis",
// 2000), planes, centroids and markers beside the poses in the reduced system. Single-threaded, sums in a fixed order:
// equal input gives equal bytes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/geometry/se3.h"
#include "core/solve/factors/dense_factor.h"
#include "core/solve/intrinsics.h"
#include "core/solve/robust.h"
#include "core/solve/structure_variables.h"

namespace vsgraphs {

// One keyframe sees one landmark. Undistorted px; inverse depth in 1/m, 0 or less where there is no reading.
struct ReprojectionObservation {
  int pose = 0;
  int landmark = 0;
  float u = 0, v = 0;
  float inverse_depth = 0;
  float inv_sigma_px = 1;             // 1/px, of the pyramid level
  float inv_sigma_inverse_depth = 0;  // m; see inv_sigma_of_inverse_depth
  bool has_depth() const { return inverse_depth > 0; }
};

struct BundleProblem {
  Intrinsics intrinsics;
  std::vector<Se3> poses;                  // world_from_camera
  std::vector<std::uint8_t> pose_fixed;    // same length as poses, or empty: none fixed
  std::vector<Eigen::Vector3d> landmarks;  // m, in the world
  std::vector<ReprojectionObservation> observations;
  StructureVariables structures;
  std::vector<std::unique_ptr<const DenseFactor>> factors;
};

struct BundleOptions {
  int max_iterations = 5;  // accepted and rejected steps alike
  // Above 0: this many iterations first, then observations beyond the 95 % gate are dropped and max_iterations follow.
  int iterations_before_dropping = 0;
  double huber_px = huber_2dof.delta;     // sigmas, observations without depth
  double huber_depth = huber_3dof.delta;  // sigmas, observations with depth
  double initial_lambda = 1e-5;           // relative to the diagonal
  double relative_tolerance =
      1e-6;                   // converged when an accepted step lowers the cost by less than this share
  int max_dense_poses = 150;  // more free variables than this: sparse Cholesky
};

struct SolveReport {
  double initial_cost = 0;  // sum of rho(|r|^2) / 2, at the start and at the end, over the same observations
  double final_cost = 0;
  int iterations = 0;  // steps tried
  int accepted = 0;    // steps taken
  bool converged = false;
  bool stopped = false;  // `stop` said so
  // Per observation, from the final state, dropped ones included.
  std::vector<ObservationFit> fit;
  int outliers = 0;
};

// Improves `problem` in place; its cost never rises (over the observations kept). `stop` is asked before each iteration.
// Without a fixed pose or a prior the gauge is free and held by the damping alone: fix one pose. Values stay finite
// whatever the input is; a landmark without usable observations stays where it is. Throws InputError for indices out of
// range, values that are not finite and arrays of the wrong length.
SolveReport solve_bundle(BundleProblem& problem, const BundleOptions& options = {},
                         const std::function<bool()>& stop = {});

}  // namespace vsgraphs
