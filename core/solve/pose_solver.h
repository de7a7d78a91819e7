// The pose of one camera from matched points of known place: Levenberg-Marquardt on SE(3) with Huber's cost, in rounds that
// tell inliers from outliers between them. Residuals as in factors/reprojection.h and factors/point_to_plane.h.
// About 15 ns per observation and iteration; memory is allocated once per call.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/se3.h"
#include "core/solve/factors/point_to_plane.h"
#include "core/solve/intrinsics.h"
#include "core/solve/robust.h"

namespace vsgraphs {

struct PoseObservation {
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();  // m
  double u = 0, v = 0;                                       // undistorted px
  double inverse_depth = 0;                                  // 1/m; 0 or less: no reading
  double inv_sigma_px = 1;                                   // 1/px, of the pyramid level
  double inv_sigma_inverse_depth = 0;                        // m; see inv_sigma_of_inverse_depth
  bool has_depth() const { return inverse_depth > 0; }
};

// What a motion model knows: information (rho, phi) in the frame of the predicted camera.
struct PosePriorTerm {
  Se3 world_from_camera;
  Matrix6d information = Matrix6d::Zero();
};

struct PoseSolverOptions {
  int rounds = 4;                         // each ends with the classification of every observation
  int iterations_per_round = 10;          // at most; a round ends when the step is negligible
  double huber_px = huber_2dof.delta;     // sigmas
  double huber_depth = huber_3dof.delta;  // sigmas, observations with depth
  double huber_plane = 1.96;              // sigmas, point-to-plane
  double negligible_step = 1e-6;          // m and rad
  // Gate the observations at the initial pose before the first round: for a pose that is good already, among matches so bad
  // that Huber's cost over all of them would pull it away.
  bool gate_first = false;
  // A direction of motion known worse than this (one sigma, m or rad) makes the pose degenerate.
  double max_sigma = 0.05;
};

struct PoseSolution {
  Se3 world_from_camera;
  std::vector<ObservationFit> fit;  // per observation; pixel_only: its depth disagrees and was left out
  std::vector<std::uint8_t> plane_inlier;  // per point-to-plane row
  int inliers = 0;                         // observations, pixel_only included
  int depth_inliers = 0;                   // of those, with a depth that agrees
  int plane_inliers = 0;
  // Of the inliers' measurements at the solution, without the prior: what was seen, not what was believed.
  Matrix6d information = Matrix6d::Zero();
  double weakest_sigma = 0;  // 1 / sqrt of the smallest eigenvalue of `information`, m or rad; infinite if 0
  double mean_chi2 = 0;      // per inlying scalar residual; about 1 where the sigmas are right
  int iterations = 0;
  bool converged = false;   // the last round ended with a negligible step
  bool degenerate = false;  // weakest_sigma > max_sigma
};

// Deterministic. Never throws for geometry: a hopeless problem returns a finite pose, not converged or degenerate.
PoseSolution solve_pose(const Intrinsics& intrinsics, const Se3& initial_world_from_camera,
                        std::span<const PoseObservation> observations,
                        std::span<const PointToPlane> planes = {},
                        const std::optional<PosePriorTerm>& prior = {},
                        const PoseSolverOptions& options = {});

}  // namespace vsgraphs
