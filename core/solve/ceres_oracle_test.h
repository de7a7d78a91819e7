// A problem of ours in Ceres: poses, landmarks and relations of poses. Tests only; never linked into what is shipped.
#pragma once

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/solve/bundle_adjustment.h"

namespace vsgraphs {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

struct Reprojection {
  Intrinsics k;
  ReprojectionObservation o;

  template <typename T>
  bool operator()(const T* quaternion, const T* translation, const T* point, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(quaternion);
    const Eigen::Map<const Vector3<T>> t(translation), x(point);
    const Vector3<T> p = q.conjugate() * (x - t);
    residual[0] = (k.fx * p.x() / p.z() + k.cx - T(o.u)) * T(o.inv_sigma_px);
    residual[1] = (k.fy * p.y() / p.z() + k.cy - T(o.v)) * T(o.inv_sigma_px);
    if (o.has_depth()) residual[2] = (T(1) / p.z() - T(o.inverse_depth)) * T(o.inv_sigma_inverse_depth);
    return true;
  }
};

// A relation of our own solver as a Ceres cost on (q, t, q, t), differentiated numerically.
struct Relative {
  const DenseFactor* factor;

  bool operator()(const double* qa, const double* ta, const double* qb, const double* tb,
                  double* residual) const {
    const auto pose = [](const double* q, const double* t) {
      return Se3::from_quaternion(Eigen::Map<const Eigen::Quaterniond>(q),
                                  Eigen::Map<const Eigen::Vector3d>(t));
    };
    std::vector<Se3> poses(
        static_cast<std::size_t>(std::max(factor->variables()[0].index, factor->variables()[1].index) + 1));
    poses[static_cast<std::size_t>(factor->variables()[0].index)] = pose(qa, ta);
    poses[static_cast<std::size_t>(factor->variables()[1].index)] = pose(qb, tb);
    FactorRows rows;
    factor->resize(rows);
    if (!factor->evaluate({poses, StructureVariables{}}, false, rows)) return false;
    Eigen::Map<Vector6d>(residual, 6) = rows.residual;
    return true;
  }
};

struct PoseParameters {
  std::array<double, 4> q;
  std::array<double, 3> t;
};

class CeresBundle {
 public:
  CeresBundle(const BundleProblem& input, const BundleOptions& options)
      : input_(input), landmarks_(input.landmarks) {
    for (std::size_t i = 0; i < input.poses.size(); ++i) add_pose(i);
    for (const ReprojectionObservation& o : input.observations) {
      ceres::CostFunction* cost = nullptr;
      if (o.has_depth()) {
        cost =
            new ceres::AutoDiffCostFunction<Reprojection, 3, 4, 3, 3>(new Reprojection{input.intrinsics, o});
      } else {
        cost =
            new ceres::AutoDiffCostFunction<Reprojection, 2, 4, 3, 3>(new Reprojection{input.intrinsics, o});
      }
      auto* loss = new ceres::HuberLoss(o.has_depth() ? options.huber_depth : options.huber_px);
      PoseParameters& pose = poses_[static_cast<std::size_t>(o.pose)];
      problem_.AddResidualBlock(cost, loss, pose.q.data(), pose.t.data(),
                                landmarks_[static_cast<std::size_t>(o.landmark)].data());
    }
  }

  // A relation of two poses.
  void add_relative(const DenseFactor& factor) {
    auto* cost =
        new ceres::NumericDiffCostFunction<Relative, ceres::CENTRAL, 6, 4, 3, 4, 3>(new Relative{&factor});
    PoseParameters& a = parameters(factor.variables()[0].index);
    PoseParameters& b = parameters(factor.variables()[1].index);
    problem_.AddResidualBlock(cost, loss_of(factor.robust()), a.q.data(), a.t.data(), b.q.data(), b.t.data());
  }

  static ceres::LossFunction* loss_of(const Huber& robust) {
    return robust.delta > 0 ? new ceres::HuberLoss(robust.delta) : nullptr;
  }
  PoseParameters& parameters(int pose) { return poses_[static_cast<std::size_t>(pose)]; }
  ceres::Problem& problem() { return problem_; }

  double solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = input_.landmarks.empty() ? ceres::DENSE_QR : ceres::DENSE_SCHUR;
    options.max_num_iterations = 200;
    options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-14;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    EXPECT_TRUE(summary.IsSolutionUsable()) << summary.BriefReport();
    return summary.final_cost;
  }

  Se3 pose(std::size_t i) const {
    return Se3::from_quaternion(Eigen::Map<const Eigen::Quaterniond>(poses_[i].q.data()),
                                Eigen::Map<const Eigen::Vector3d>(poses_[i].t.data()));
  }

 private:
  void add_pose(std::size_t i) {
    if (poses_.empty()) poses_.resize(input_.poses.size());
    PoseParameters& pose = poses_[i];
    Eigen::Map<Eigen::Vector4d>(pose.q.data()) = input_.poses[i].quaternion().coeffs();
    Eigen::Map<Eigen::Vector3d>(pose.t.data()) = input_.poses[i].translation();
    problem_.AddParameterBlock(pose.q.data(), 4, new ceres::EigenQuaternionManifold);
    problem_.AddParameterBlock(pose.t.data(), 3);
    if (!input_.pose_fixed[i]) return;
    problem_.SetParameterBlockConstant(pose.q.data());
    problem_.SetParameterBlockConstant(pose.t.data());
  }

  const BundleProblem& input_;
  std::vector<PoseParameters> poses_;
  std::vector<Eigen::Vector3d> landmarks_;
  ceres::Problem problem_;
};

}  // namespace vsgraphs
