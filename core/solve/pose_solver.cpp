#include "core/solve/pose_solver.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/se3_jacobian.h"
#include "core/solve/pose_normal.h"

namespace vsgraphs {
namespace {

class Solver {
 public:
  Solver(const Intrinsics& intrinsics, std::span<const PoseObservation> observations,
         std::span<const PointToPlane> planes, const std::optional<PosePriorTerm>& prior,
         const PoseSolverOptions& options)
      : rows_(intrinsics, observations, options), planes_(planes), prior_(prior), options_(options) {
    plane_in_use_.assign(planes.size(), 1);
  }

  PoseSolution solve(const Se3& initial) {
    PoseSolution out;
    out.world_from_camera = initial;
    if (options_.gate_first) classify_all(out);
    for (int round = 0; round < std::max(options_.rounds, 1); ++round) {
      out.converged = minimise(out.world_from_camera, out.iterations);
      classify_all(out);
      if (2 * out.inliers + out.plane_inliers < 6 && !prior_) break;  // nothing left to solve with
    }
    finish(out);
    return out;
  }

 private:
  // Levenberg-Marquardt on the observations in use; true when it ended with a negligible step.
  bool minimise(Se3& pose, int& iterations) const {
    PoseNormal now = normal_at(pose);
    double lambda = 1e-6;
    for (int i = 0; i < options_.iterations_per_round; ++i) {
      ++iterations;
      Matrix6d damped = now.h;
      damped.diagonal() += lambda * now.h.diagonal().cwiseMax(1e-6);
      const Vector6d step = damped.llt().solve(now.b);
      if (!step.allFinite()) {
        lambda = std::max(1e-3, lambda * 100);
        continue;
      }
      const bool negligible = step.cwiseAbs().maxCoeff() < options_.negligible_step;
      const Se3 trial = pose.retract(step);
      if (negligible) {
        pose = trial;
        return true;
      }
      const PoseNormal next = normal_at(trial);
      if (next.cost <= now.cost) {
        pose = trial;
        now = next;
        lambda = std::max(1e-9, lambda * 0.1);
      } else {
        lambda = std::max(1e-3, lambda * 10);
      }
    }
    return false;
  }

  PoseNormal normal_at(const Se3& pose) const {
    PoseNormal sum;
    rows_.accumulate(pose, sum);
    add_planes(pose, sum);
    if (prior_) {
      const Vector6d error = (prior_->world_from_camera.inverse() * pose).log();
      const Matrix6d jacobian = se3_right_jacobian_inverse(error);
      const Vector6d weighted = prior_->information * error;
      sum.h += jacobian.transpose() * prior_->information * jacobian;
      sum.b -= jacobian.transpose() * weighted;
      sum.cost += 0.5 * error.dot(weighted);
    }
    return sum;
  }

  void add_planes(const Se3& pose, PoseNormal& sum) const {
    const Huber huber{options_.huber_plane};
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      if (!plane_in_use_[i]) continue;
      Vector6d jacobian;
      const double residual = point_to_plane(pose, planes_[i], &jacobian);
      const double weight = huber.weight(residual * residual);
      sum.h.noalias() += jacobian * (weight * jacobian).transpose();
      sum.b -= (weight * residual) * jacobian;
      sum.cost += 0.5 * huber.cost(residual * residual);
    }
  }

  void classify_all(PoseSolution& out) {
    int rows = 0;
    double squares = 0;
    rows_.classify_all(out.world_from_camera, out.fit, squares, rows);
    out.inliers = static_cast<int>(std::count_if(out.fit.begin(), out.fit.end(), is_inlier));
    out.depth_inliers = rows - 2 * out.inliers;
    out.plane_inliers = 0;
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const double residual = point_to_plane(out.world_from_camera, planes_[i], nullptr);
      plane_in_use_[i] = residual * residual <= chi2_95_1;
      if (!plane_in_use_[i]) continue;
      ++out.plane_inliers;
      squares += residual * residual;
    }
    rows += out.plane_inliers;
    out.mean_chi2 = rows > 0 ? squares / rows : 0.0;
  }

  void finish(PoseSolution& out) const {
    PoseNormal measured;
    rows_.accumulate(out.world_from_camera, measured);
    add_planes(out.world_from_camera, measured);
    out.information = measured.h;
    out.plane_inlier = plane_in_use_;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(measured.h, Eigen::EigenvaluesOnly);
    const double smallest = eigen.eigenvalues()[0];
    // Below the digits of the largest it is rounding, not information.
    const bool nothing = !(smallest > 1e-14 * eigen.eigenvalues()[5]);
    out.weakest_sigma = nothing ? std::numeric_limits<double>::infinity() : 1.0 / std::sqrt(smallest);
    out.degenerate = !(out.weakest_sigma <= options_.max_sigma);
  }

  PoseRows rows_;
  std::span<const PointToPlane> planes_;
  std::vector<std::uint8_t> plane_in_use_;
  const std::optional<PosePriorTerm>& prior_;
  const PoseSolverOptions& options_;
};

}  // namespace

PoseSolution solve_pose(const Intrinsics& intrinsics, const Se3& initial_world_from_camera,
                        std::span<const PoseObservation> observations, std::span<const PointToPlane> planes,
                        const std::optional<PosePriorTerm>& prior, const PoseSolverOptions& options) {
  return Solver(intrinsics, observations, planes, prior, options).solve(initial_world_from_camera);
}

}  // namespace vsgraphs
