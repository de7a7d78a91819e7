// The written-out, vectorised normal equations and their elimination against the factor itself and a dense solve.
#include "core/solve/bundle/landmark_part.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>

#include "core/solve/factors/reprojection.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

// Three poses (the second fixed), some landmarks; among the observations: outliers, a point behind a camera, one landmark
// seen twice from one pose.
BundleProblem awkward_problem() {
  SyntheticWindowOptions options;
  options.fixed_poses = 0;
  options.free_poses = 3;
  options.landmarks = 7;
  options.views_per_landmark = 3;
  options.outlier_share = 0.2;
  BundleProblem problem = synthetic_window(options, 5).problem;
  problem.pose_fixed = {0, 1, 0};
  problem.landmarks[6] = problem.poses[2] * Eigen::Vector3d(0.1, 0.2, -1.0);
  problem.observations.push_back(problem.observations[0]);
  problem.observations.back().u += 1;
  return problem;
}

struct System {
  Eigen::MatrixXd h;
  Eigen::VectorXd b;
  double cost = 0;
};

// Poses first (fixed ones left out), then landmarks, from the factor's own Jacobians.
System from_factors(const BundleProblem& problem, const std::vector<int>& variable, int free_poses) {
  const int size = 6 * free_poses + 3 * static_cast<int>(problem.landmarks.size());
  System s{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), 0};
  for (const auto& o : problem.observations) {
    const ReprojectionMeasurement m{o.u, o.v, o.inverse_depth, o.inv_sigma_px, o.inv_sigma_inverse_depth};
    const auto add = [&](const auto& rows, bool valid, const Huber& huber) {
      const double squared = valid ? rows.residual.squaredNorm() : 1e4;
      s.cost += 0.5 * huber.cost(squared);
      if (!valid) return;
      Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows.residual.size(), size);
      if (variable[o.pose] >= 0) jacobian.middleCols<6>(6 * variable[o.pose]) = rows.by_pose;
      jacobian.middleCols<3>(6 * free_poses + 3 * o.landmark) = rows.by_point;
      s.h += huber.weight(squared) * jacobian.transpose() * jacobian;
      s.b -= huber.weight(squared) * jacobian.transpose() * rows.residual;
    };
    ReprojectionRows<3> rows3;
    ReprojectionRows<2> rows2;
    const Se3& pose = problem.poses[o.pose];
    const Eigen::Vector3d& point = problem.landmarks[o.landmark];
    if (o.has_depth()) {
      const bool valid = reprojection(problem.intrinsics, pose, point, m, rows3);
      add(rows3, valid, huber_3dof);
    } else {
      const bool valid = reprojection(problem.intrinsics, pose, point, m, rows2);
      add(rows2, valid, huber_2dof);
    }
  }
  return s;
}

TEST(LandmarkPart, EliminationSolvesTheFactorsNormalEquations) {
  const BundleProblem problem = awkward_problem();
  const std::vector<int> variable{0, -1, 1};
  constexpr int free_poses = 2;
  constexpr double lambda = 1e-3;
  System full = from_factors(problem, variable, free_poses);

  LandmarkPart part(problem, variable, {});
  EXPECT_NEAR(part.cost(problem.poses, problem.landmarks), full.cost, 1e-10 * full.cost);
  std::vector<std::vector<int>> rows{{0}, {1}};
  part.add_pairs(rows);
  ASSERT_EQ(rows[0], (std::vector<int>{0, 1}));
  BlockMatrix pattern;
  pattern.build({6, 6}, rows);
  part.bind(pattern);
  std::vector<double> values(pattern.value_count(), 0.0);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(12);
  part.linearise(problem.poses, problem.landmarks, values.data(), b);
  EXPECT_TRUE(b.isApprox(full.b.head<12>(), 1e-11));
  Eigen::MatrixXd reduced;
  pattern.to_dense(values.data(), reduced);
  const Eigen::MatrixXd expected = full.h.topLeftCorner<12, 12>();
  EXPECT_TRUE(reduced.triangularView<Eigen::Lower>().toDenseMatrix().isApprox(
      expected.triangularView<Eigen::Lower>().toDenseMatrix(), 1e-11));

  // Damped as the part damps its landmarks; the poses' damping is the caller's, here a constant.
  constexpr double pose_damping = 5.0;
  full.h.diagonal().head<12>().array() += pose_damping;
  for (int l = 0; l < static_cast<int>(problem.landmarks.size()); ++l) {
    auto diagonal = full.h.diagonal().segment<3>(12 + 3 * l);
    diagonal += lambda * diagonal.cwiseMax(1e-3) + Eigen::Vector3d::Constant(1e-9 * diagonal.sum());
  }
  const Eigen::VectorXd step = full.h.ldlt().solve(full.b);
  for (int v = 0; v < 2; ++v) {
    Eigen::Map<Matrix6d>(values.data() + pattern.value_begin(pattern.diagonal(v))).diagonal().array() +=
        pose_damping;
  }
  part.eliminate(lambda, values.data(), b);
  Eigen::VectorXd pose_step;
  ASSERT_TRUE(ReducedSolver(pattern, false).solve(values.data(), b, pose_step));
  EXPECT_LT((pose_step - step.head<12>()).norm(), 1e-9 * step.norm());
  std::vector<Eigen::Vector3d> moved(problem.landmarks.size());
  part.back_substitute(lambda, pose_step, problem.landmarks, moved);
  for (std::size_t l = 0; l < moved.size(); ++l) {
    const Eigen::Vector3d expected_step = step.segment<3>(12 + 3 * static_cast<Eigen::Index>(l));
    EXPECT_LT((moved[l] - problem.landmarks[l] - expected_step).norm(), 1e-9 * (1 + step.norm())) << l;
  }
}

TEST(LandmarkPart, PredictsTheDecreaseOfItsModel) {
  const BundleProblem problem = awkward_problem();
  const System full = from_factors(problem, {-1, -1, -1}, 0);
  LandmarkPart part(problem, {-1, -1, -1}, {});
  part.bind(BlockMatrix());
  Eigen::VectorXd b(0), step(0);
  part.linearise(problem.poses, problem.landmarks, nullptr, b);
  part.eliminate(1e-4, nullptr, b);
  std::vector<Eigen::Vector3d> moved(problem.landmarks.size());
  const double predicted = part.back_substitute(1e-4, step, problem.landmarks, moved);
  Eigen::VectorXd delta(full.b.size());
  for (std::size_t l = 0; l < moved.size(); ++l)
    delta.segment<3>(3 * static_cast<Eigen::Index>(l)) = moved[l] - problem.landmarks[l];
  const double model = full.b.dot(delta) - 0.5 * delta.dot(full.h * delta);
  EXPECT_NEAR(predicted, model, 1e-9 * std::abs(model));
}

TEST(LandmarkPart, DroppedObservationsHaveNoWeight) {
  BundleProblem problem = awkward_problem();
  const std::vector<int> variable{0, -1, 1};
  LandmarkPart part(problem, variable, {});
  std::vector<ObservationFit> fit(problem.observations.size(), ObservationFit::inlier);
  fit[2] = fit[9] = ObservationFit::outlier;
  std::vector<ReprojectionObservation> kept;
  bool demoted = false;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (fit[i] == ObservationFit::outlier) continue;
    kept.push_back(problem.observations[i]);
    if (demoted || !kept.back().has_depth()) continue;
    demoted = true;
    kept.back().inverse_depth = 0;
    fit[i] = ObservationFit::pixel_only;
  }
  part.drop(fit);
  problem.observations = kept;
  const double expected = LandmarkPart(problem, variable, {}).cost(problem.poses, problem.landmarks);
  EXPECT_NEAR(part.cost(problem.poses, problem.landmarks), expected, 1e-12 * expected);
}

}  // namespace
}  // namespace vsgraphs
