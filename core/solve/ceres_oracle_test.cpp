// The same problems in Ceres, with automatic derivatives and its own pose parameters: both must reach the same optimum.
#include "core/solve/ceres_oracle_test.h"

#include "core/solve/factors/relative_pose.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

void expect_same_optimum(BundleProblem& problem, BundleOptions options = {}) {
  options.max_iterations = 200;
  options.relative_tolerance = 1e-13;
  CeresBundle oracle(problem, options);
  for (const auto& factor : problem.factors) oracle.add_relative(*factor);
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
