#include "core/solve/bundle_adjustment.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "core/base/check.h"
#include "core/solve/factors/pose_prior.h"
#include "core/solve/factors/relative_pose.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

SyntheticWindowOptions small() {
  SyntheticWindowOptions options;
  options.fixed_poses = 3;
  options.free_poses = 6;
  options.landmarks = 300;
  return options;
}

double worst_pose_error(const SyntheticWindow& w) {
  double worst = 0;
  for (std::size_t i = 0; i < w.true_poses.size(); ++i) {
    worst = std::max(worst, (w.true_poses[i].inverse() * w.problem.poses[i]).log().norm());
  }
  return worst;
}

BundleOptions iterations(int n) {
  BundleOptions options;
  options.max_iterations = n;
  return options;
}

TEST(BundleAdjustment, FindsTheTruthWithoutNoise) {
  SyntheticWindowOptions options = small();
  options.noise = false;
  SyntheticWindow w = synthetic_window(options);
  BundleOptions solve = iterations(20);
  solve.relative_tolerance = 1e-12;
  const SolveReport report = solve_bundle(w.problem, solve);
  EXPECT_LT(report.final_cost, 1e-3 * static_cast<double>(w.problem.observations.size()));
  EXPECT_LT(worst_pose_error(w), 1e-4);
  EXPECT_EQ(report.outliers, 0);
  for (std::size_t l = 0; l < w.true_landmarks.size(); ++l) {
    EXPECT_LT((w.problem.landmarks[l] - w.true_landmarks[l]).norm(), 2e-3);
  }
}

TEST(BundleAdjustment, FiveIterationsAreEnoughForAWindow) {
  SyntheticWindow w = synthetic_window(small());
  SyntheticWindow longer = synthetic_window(small());
  const SolveReport report = solve_bundle(w.problem, iterations(5));
  const SolveReport optimum = solve_bundle(longer.problem, iterations(50));
  EXPECT_TRUE(optimum.converged);
  EXPECT_LT(report.final_cost, 1.001 * optimum.final_cost);
  EXPECT_LT(worst_pose_error(w), 0.01);
  EXPECT_EQ(report.iterations, 5);
}

TEST(BundleAdjustment, FixedPosesDoNotMove) {
  SyntheticWindow w = synthetic_window(small());
  const std::vector<Se3> before = w.problem.poses;
  solve_bundle(w.problem);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(0, std::memcmp(&before[i], &w.problem.poses[i], sizeof(Se3)));
  EXPECT_NE(0, std::memcmp(&before[3], &w.problem.poses[3], sizeof(Se3)));
}

TEST(BundleAdjustment, TwoPhasesFindPlantedOutliers) {
  SyntheticWindowOptions options = small();
  options.outlier_share = 0.08;
  SyntheticWindow w = synthetic_window(options);
  BundleOptions solve = iterations(5);
  solve.iterations_before_dropping = 4;
  const SolveReport report = solve_bundle(w.problem, solve);
  int planted = 0, found = 0, lost = 0;
  for (std::size_t i = 0; i < w.planted.size(); ++i) {
    planted += w.planted[i];
    found += w.planted[i] && !is_inlier(report.fit[i]);
    lost += !w.planted[i] && !is_inlier(report.fit[i]);
  }
  EXPECT_GE(found, 0.98 * planted);
  EXPECT_LE(lost, 0.08 * static_cast<double>(w.planted.size()));  // the gate alone takes 5 %
  EXPECT_LT(worst_pose_error(w), 0.012);
  EXPECT_LE(report.final_cost, report.initial_cost);
}

TEST(BundleAdjustment, LandmarksSeenOnceOrNeverStayFinite) {
  SyntheticWindow w = synthetic_window(small());
  auto& problem = w.problem;
  for (auto& o : problem.observations) {
    if (o.landmark < 50) o.inverse_depth = 0;
  }
  // Landmarks 0..49 keep their first view, without depth; 50..59 lose all.
  std::vector<ReprojectionObservation> kept;
  std::vector<int> views(300, 0);
  for (const auto& o : problem.observations) {
    if (o.landmark < 50 && views[o.landmark]++ > 0) continue;
    if (o.landmark >= 50 && o.landmark < 60) continue;
    kept.push_back(o);
  }
  problem.observations = kept;
  const Eigen::Vector3d untouched = problem.landmarks[55];
  const std::vector<Eigen::Vector3d> before = problem.landmarks;
  const SolveReport report = solve_bundle(problem, iterations(10));
  EXPECT_GT(report.accepted, 0);
  EXPECT_LT(worst_pose_error(w), 0.02);
  EXPECT_EQ(problem.landmarks[55], untouched);
  for (int l = 0; l < 50; ++l) {
    EXPECT_TRUE(problem.landmarks[l].allFinite());
    EXPECT_LT((problem.landmarks[l] - before[l]).norm(), 0.5);  // moves onto its ray, not along it
  }
}

TEST(BundleAdjustment, AllPosesFixedTriangulates) {
  SyntheticWindowOptions options = small();
  options.fixed_poses = 9;
  options.free_poses = 0;
  options.noise = false;
  SyntheticWindow w = synthetic_window(options);
  const SolveReport report = solve_bundle(w.problem, iterations(10));
  EXPECT_LT(report.final_cost, 1e-3 * static_cast<double>(w.problem.observations.size()));
  for (std::size_t l = 0; l < w.true_landmarks.size(); ++l) {
    EXPECT_LT((w.problem.landmarks[l] - w.true_landmarks[l]).norm(), 2e-3);
  }
}

TEST(BundleAdjustment, EmptyProblemsAreSolved) {
  BundleProblem nothing;
  const SolveReport report = solve_bundle(nothing);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.final_cost, 0);
  BundleProblem lonely;
  lonely.poses.resize(3);
  lonely.landmarks.resize(4, Eigen::Vector3d(0, 0, 2));
  const SolveReport second = solve_bundle(lonely);
  EXPECT_EQ(second.final_cost, 0);
  EXPECT_TRUE(lonely.poses[2].finite());
}

TEST(BundleAdjustment, StopEndsBetweenIterationsAndKeepsTheProgress) {
  SyntheticWindow w = synthetic_window(small());
  int asked = 0;
  const SolveReport report = solve_bundle(w.problem, iterations(10), [&] { return ++asked > 2; });
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_LT(report.final_cost, report.initial_cost);
  EXPECT_EQ(report.fit.size(), w.problem.observations.size());

  SyntheticWindow untouched = synthetic_window(small());
  const SolveReport none = solve_bundle(untouched.problem, {}, [] { return true; });
  EXPECT_EQ(none.iterations, 0);
  EXPECT_EQ(none.final_cost, none.initial_cost);
}

TEST(BundleAdjustment, TwiceTheSameBytes) {
  SyntheticWindow a = synthetic_window(small()), b = synthetic_window(small());
  solve_bundle(a.problem);
  solve_bundle(b.problem);
  EXPECT_EQ(
      0, std::memcmp(a.problem.poses.data(), b.problem.poses.data(), a.problem.poses.size() * sizeof(Se3)));
  EXPECT_EQ(0, std::memcmp(a.problem.landmarks.data(), b.problem.landmarks.data(),
                           a.problem.landmarks.size() * sizeof(Eigen::Vector3d)));
}

TEST(BundleAdjustment, SparseAndDenseAgree) {
  SyntheticWindow dense = synthetic_window(small()), sparse = synthetic_window(small());
  const auto add_marker = [](BundleProblem& p) {
    p.structures.markers.push_back(p.poses[8] * Se3::exp(Vector6d::Constant(0.1)));
    p.factors.push_back(std::make_unique<RelativePose>(VariableRef{VariableKind::marker, 0},
                                                       VariableRef{VariableKind::pose, 2}, Se3(),
                                                       10 * Matrix6d::Identity()));
    p.factors.push_back(std::make_unique<PosePrior>(VariableRef{VariableKind::marker, 0}, p.poses[1],
                                                    7 * Matrix6d::Identity()));
  };
  add_marker(dense.problem);
  add_marker(sparse.problem);
  BundleOptions options;
  solve_bundle(dense.problem, options);
  options.max_dense_poses = 0;
  solve_bundle(sparse.problem, options);
  for (std::size_t i = 0; i < dense.problem.poses.size(); ++i) {
    EXPECT_LT((dense.problem.poses[i].inverse() * sparse.problem.poses[i]).log().norm(), 1e-9);
  }
  EXPECT_TRUE(dense.problem.structures.markers[0].matrix().isApprox(
      sparse.problem.structures.markers[0].matrix(), 1e-9));
}

TEST(BundleAdjustment, SeveralViewsOfALandmarkFromOnePoseCountEach) {
  SyntheticWindow once = synthetic_window(small()), twice = synthetic_window(small());
  const auto all = twice.problem.observations;
  twice.problem.observations.insert(twice.problem.observations.end(), all.begin(), all.end());
  const SolveReport a = solve_bundle(once.problem, iterations(20)),
                    b = solve_bundle(twice.problem, iterations(20));
  EXPECT_NEAR(b.final_cost, 2 * a.final_cost, 1e-4 * b.final_cost);
  for (std::size_t i = 0; i < once.problem.poses.size(); ++i) {
    EXPECT_LT((once.problem.poses[i].inverse() * twice.problem.poses[i]).log().norm(), 1e-4);
  }
}

TEST(BundleAdjustment, WildStartsStayFiniteAndNeverGetWorse) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SyntheticWindowOptions options = small();
    options.pose_error_m = 1.0;
    options.pose_error_rad = 0.8;
    options.landmark_error_m = 2.0;
    SyntheticWindow w = synthetic_window(options, seed);
    const SolveReport report = solve_bundle(w.problem, iterations(15));
    EXPECT_LE(report.final_cost, report.initial_cost);
    for (const Se3& pose : w.problem.poses) EXPECT_TRUE(pose.finite());
    for (const auto& point : w.problem.landmarks) EXPECT_TRUE(point.allFinite());
  }
}

TEST(BundleAdjustment, PosesInChainWithoutLandmarksAreAPoseGraph) {
  BundleProblem graph;
  Rng rng(4, "graph", 0);
  std::vector<Se3> truth;
  for (int i = 0; i < 400; ++i) {
    truth.push_back(Se3::exp((Vector6d() << 0, 0, 0, 0, 0.0157 * i, 0).finished()) *
                    Se3(Eigen::Matrix3d::Identity(), {3, 0, 0}));
    graph.poses.push_back(truth.back());
    graph.pose_fixed.push_back(i == 0);
  }
  const Matrix6d sqrt_information = 50 * Matrix6d::Identity();
  for (int i = 1; i < 400; ++i) {  // odometry drifts, the loop knows
    const Se3 measured = truth[i - 1].inverse() * truth[i] * Se3::exp(random_tangent(rng, 0.002, 0.001));
    graph.poses[i] = graph.poses[i - 1] * measured;
    graph.factors.push_back(std::make_unique<RelativePose>(VariableRef{VariableKind::pose, i - 1},
                                                           VariableRef{VariableKind::pose, i}, measured,
                                                           sqrt_information));
  }
  const double drift = (graph.poses[399].translation() - truth[399].translation()).norm();
  graph.factors.push_back(
      std::make_unique<RelativePose>(VariableRef{VariableKind::pose, 399}, VariableRef{VariableKind::pose, 0},
                                     truth[399].inverse() * truth[0], 10 * sqrt_information));
  const SolveReport report = solve_bundle(graph, iterations(20));
  EXPECT_TRUE(report.converged);
  EXPECT_GT(drift, 0.02);
  EXPECT_LT((graph.poses[399].translation() - truth[399].translation()).norm(), 0.1 * drift);
}

TEST(BundleAdjustment, RefusesWhatItCannotUse) {
  const auto refused = [](auto change) {
    SyntheticWindow w = synthetic_window(small());
    change(w.problem);
    EXPECT_THROW(solve_bundle(w.problem), InputError);
  };
  refused([](BundleProblem& p) { p.observations[5].pose = 9; });
  refused([](BundleProblem& p) { p.observations[5].landmark = -1; });
  refused([](BundleProblem& p) { p.observations[5].u = std::numeric_limits<float>::quiet_NaN(); });
  refused([](BundleProblem& p) { p.observations[5].inv_sigma_px = 0; });
  refused([](BundleProblem& p) { p.landmarks[7].y() = std::numeric_limits<double>::infinity(); });
  refused([](BundleProblem& p) { p.pose_fixed.pop_back(); });
  refused([](BundleProblem& p) { p.intrinsics.fx = 0; });
  refused([](BundleProblem& p) { p.factors.push_back(nullptr); });
  refused([](BundleProblem& p) {
    p.factors.push_back(
        std::make_unique<PosePrior>(VariableRef{VariableKind::marker, 0}, Se3(), Matrix6d::Identity()));
  });
}

}  // namespace
}  // namespace vsgraphs
