// The same problems in Ceres, with automatic derivatives and its own pose parameters: both must reach the same optimum.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "core/solve/bundle_adjustment.h"
#include "core/solve/factors/relative_pose.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

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
    for (const auto& factor : input.factors) {
      auto* cost = new ceres::NumericDiffCostFunction<Relative, ceres::CENTRAL, 6, 4, 3, 4, 3>(
          new Relative{factor.get()});
      PoseParameters& a = poses_[static_cast<std::size_t>(factor->variables()[0].index)];
      PoseParameters& b = poses_[static_cast<std::size_t>(factor->variables()[1].index)];
      auto* loss = factor->robust().delta > 0 ? new ceres::HuberLoss(factor->robust().delta) : nullptr;
      problem_.AddResidualBlock(cost, loss, a.q.data(), a.t.data(), b.q.data(), b.t.data());
    }
  }

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

void expect_same_optimum(BundleProblem& problem, BundleOptions options = {}) {
  options.max_iterations = 200;
  options.relative_tolerance = 1e-13;
  CeresBundle oracle(problem, options);
  const double cost = oracle.solve();
  const SolveReport report = solve_bundle(problem, options);
  EXPECT_TRUE(report.converged);
  EXPECT_NEAR(report.final_cost, cost, 1e-6 * cost);
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    EXPECT_LT((oracle.pose(i).inverse() * problem.poses[i]).log().norm(), 1e-5) << "pose " << i;
  }
}

SyntheticWindowOptions window(double outliers) {
  SyntheticWindowOptions options;
  options.fixed_poses = 3;
  options.free_poses = 8;
  options.landmarks = 400;
  options.outlier_share = outliers;
  return options;
}

TEST(CeresOracle, CleanWindow) {
  SyntheticWindow w = synthetic_window(window(0), 11);
  expect_same_optimum(w.problem);
}

TEST(CeresOracle, WindowWithOutliers) {
  SyntheticWindow w = synthetic_window(window(0.05), 12);
  expect_same_optimum(w.problem);
}

TEST(CeresOracle, PixelsOnlyWithOneFixedPoseAndAnOdometryFactor) {
  SyntheticWindowOptions options = window(0.0);
  options.depth_share = 0;
  options.fixed_poses = 1;
  options.landmark_error_m = 0.01;
  SyntheticWindow w = synthetic_window(options, 13);
  // Pixels alone leave the scale open: one relative pose gives it.
  w.problem.factors.push_back(std::make_unique<RelativePose>(
      VariableRef{VariableKind::pose, 0}, VariableRef{VariableKind::pose, 7},
      w.true_poses[0].inverse() * w.true_poses[7], 300 * Matrix6d::Identity()));
  expect_same_optimum(w.problem);
}

TEST(CeresOracle, SparseSolver) {
  SyntheticWindow w = synthetic_window(window(0.03), 14);
  BundleOptions options;
  options.max_dense_poses = 0;
  expect_same_optimum(w.problem, options);
}

TEST(CeresOracle, PoseGraphWithAWrongLoop) {
  BundleProblem graph;
  Rng rng(5, "ceres_oracle_test", 0);
  const int n = 30;
  std::vector<Se3> truth;
  for (int i = 0; i < n; ++i) {
    truth.push_back(camera_on_arc(0.1 * i));
    graph.poses.push_back(truth.back().retract(random_tangent(rng, 0.05, 0.03)));
    graph.pose_fixed.push_back(i == 0);
  }
  const auto relate = [&](int a, int b, const Se3& measured, Huber robust) {
    graph.factors.push_back(std::make_unique<RelativePose>(VariableRef{VariableKind::pose, a},
                                                           VariableRef{VariableKind::pose, b}, measured,
                                                           40 * Matrix6d::Identity(), robust));
  };
  for (int i = 1; i < n; ++i) {
    relate(i - 1, i, truth[i - 1].inverse() * truth[i] * Se3::exp(random_tangent(rng, 0.02, 0.02)), {});
  }
  relate(n - 1, 0, truth[n - 1].inverse() * truth[0] * Se3::exp(random_tangent(rng, 0.02, 0.02)), {2});
  relate(10, 20, Se3::exp(Vector6d::Constant(0.3)), {2});
  expect_same_optimum(graph);
}

}  // namespace
}  // namespace vsgraphs
