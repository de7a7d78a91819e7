#include "core/solve/marginals.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/geometry/pose_covariance.h"
#include "core/solve/factors/pose_prior.h"
#include "core/solve/factors/reprojection.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

SyntheticWindowOptions small_window(int free_poses) {
  SyntheticWindowOptions o;
  o.fixed_poses = 1;
  o.free_poses = free_poses;
  o.landmarks = 60;
  o.views_per_landmark = 1 + free_poses;
  return o;
}

// J'J of all observations, without robust weights: free poses first, then landmarks.
Eigen::MatrixXd full_information(const BundleProblem& problem) {
  const auto poses = static_cast<Eigen::Index>(problem.poses.size()) - 1;  // the first is fixed
  const auto size = 6 * poses + 3 * static_cast<Eigen::Index>(problem.landmarks.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  const auto add = [&](const auto& rows, const ReprojectionObservation& o) {
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows.residual.rows(), size);
    if (o.pose > 0) jacobian.middleCols<6>(6 * (o.pose - 1)) = rows.by_pose;
    jacobian.middleCols<3>(6 * poses + 3 * o.landmark) = rows.by_point;
    information += jacobian.transpose() * jacobian;
  };
  for (const ReprojectionObservation& o : problem.observations) {
    const ReprojectionMeasurement m{o.u, o.v, o.inverse_depth, o.inv_sigma_px, o.inv_sigma_inverse_depth};
    const Se3& pose = problem.poses[static_cast<std::size_t>(o.pose)];
    const Eigen::Vector3d& point = problem.landmarks[static_cast<std::size_t>(o.landmark)];
    ReprojectionRows<3> three;
    ReprojectionRows<2> two;
    if (o.has_depth() && reprojection(problem.intrinsics, pose, point, m, three)) add(three, o);
    if (!o.has_depth() && reprojection(problem.intrinsics, pose, point, m, two)) add(two, o);
  }
  return information;
}

double relative_difference(const Matrix6d& is, const Matrix6d& should) {
  return (is - should).norm() / should.norm();
}

constexpr BundleOptions not_robust{.huber_px = 0, .huber_depth = 0};

TEST(Marginals, AreWhatTheDenseInverseSays) {
  const BundleProblem problem = synthetic_window(small_window(3)).problem;
  const Eigen::MatrixXd covariance = full_information(problem).inverse();
  const auto from_fixed = relative_covariance(problem, 0, 2, {}, not_robust);
  ASSERT_TRUE(from_fixed);
  EXPECT_LT(relative_difference(*from_fixed, covariance.block<6, 6>(6, 6)), 1e-6);

  // Between two free ones: as the difference of both moves.
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(6, covariance.cols());
  const Se3 a_from_b = problem.poses[1].inverse() * problem.poses[3];
  constexpr double step = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6d xi = step * Vector6d::Unit(i);
    const Se3 a_moved = problem.poses[1].retract(xi).inverse() * problem.poses[3];
    jacobian.col(i) = (a_from_b.inverse() * a_moved).log() / step;
    jacobian(i, 12 + i) = 1;
  }
  const auto between = relative_covariance(problem, 1, 3, {}, not_robust);
  ASSERT_TRUE(between);
  EXPECT_LT(relative_difference(*between, jacobian * covariance * jacobian.transpose()), 1e-5);
}

TEST(Marginals, SeenFromEitherEndTheyAreTheSame) {
  const BundleProblem problem = synthetic_window(small_window(2)).problem;
  const auto forth = relative_covariance(problem, 0, 2), back = relative_covariance(problem, 2, 0);
  ASSERT_TRUE(forth && back);
  const Se3 a_from_b = problem.poses[0].inverse() * problem.poses[2];
  EXPECT_LT(relative_difference(*back, inverted_covariance(a_from_b, *forth)), 1e-9);
}

TEST(Marginals, WhatWasDroppedSaysNothing) {
  BundleProblem problem = synthetic_window(small_window(2)).problem;
  std::vector<ObservationFit> fit(problem.observations.size(), ObservationFit::inlier);
  BundleProblem rest;
  rest.intrinsics = problem.intrinsics;
  rest.poses = problem.poses;
  rest.pose_fixed = problem.pose_fixed;
  rest.landmarks = problem.landmarks;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (problem.observations[i].landmark % 2 == 0)
      fit[i] = ObservationFit::outlier;
    else
      rest.observations.push_back(problem.observations[i]);
  }
  const auto dropped = relative_covariance(problem, 0, 2, fit), without = relative_covariance(rest, 0, 2);
  ASSERT_TRUE(dropped && without);
  EXPECT_LT(relative_difference(*dropped, *without), 1e-9);
}

TEST(Marginals, ThereAreNoneOfWhatNothingHolds) {
  BundleProblem problem = synthetic_window(small_window(2)).problem;
  std::erase_if(problem.observations, [](const ReprojectionObservation& o) { return o.pose == 2; });
  EXPECT_FALSE(relative_covariance(problem, 0, 2).has_value());
  EXPECT_FALSE(relative_covariance(problem, 0, 1).has_value());
}

TEST(Marginals, OtherFactorsCount) {
  BundleProblem problem = synthetic_window(small_window(2)).problem;
  const auto alone = relative_covariance(problem, 0, 2);
  problem.factors.push_back(std::make_unique<PosePrior>(VariableRef{VariableKind::pose, 2}, problem.poses[2],
                                                        1e6 * Matrix6d::Identity(), Huber{}));
  const auto held = relative_covariance(problem, 0, 2);
  ASSERT_TRUE(alone && held);
  EXPECT_LT(held->trace(), 1e-3 * alone->trace());
  EXPECT_LT(held->trace(), 6.1e-12);
}

// Normalised error squared per degree of freedom, over many noises: 1 where the covariance says what the errors are.
TEST(Marginals, SayHowLargeTheErrorsAre) {
  constexpr int rounds = 40;
  double squared = 0;
  for (int seed = 1; seed <= rounds; ++seed) {
    SyntheticWindow w = synthetic_window(small_window(2), static_cast<std::uint64_t>(seed));
    const SolveReport report = solve_bundle(w.problem, {.max_iterations = 15});
    const auto covariance = relative_covariance(w.problem, 0, 2, report.fit);
    ASSERT_TRUE(covariance);
    const Vector6d error = (w.problem.poses[2].inverse() * w.true_poses[2]).log();
    squared += std::pow(sigmas_of(error, *covariance), 2) / 6;
  }
  EXPECT_GT(squared / rounds, 0.6);
  EXPECT_LT(squared / rounds, 1.7);
}

}  // namespace
}  // namespace vsgraphs
