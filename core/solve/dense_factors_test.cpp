// The mechanism of structure in the joint problem, with relations made up for the test.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/rng.h"
#include "core/solve/bundle_adjustment.h"
#include "core/solve/factors/jacobian_test.h"
#include "core/solve/factors/pose_prior.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

// A plane seen from a pose as its normal and distance in the camera: 4 numbers, overdetermined by one.
class PlaneSeen final : public DenseFactor {
 public:
  PlaneSeen(int pose, int plane, const Eigen::Vector3d& normal, double distance, Huber robust = {})
      : DenseFactor({{VariableKind::pose, pose}, {VariableKind::plane, plane}}, 4, robust),
        normal_(normal),
        distance_(distance) {}

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const Se3& t = values.pose(variables()[0].index);
    const AnchoredPlane& plane = values.plane(variables()[1].index);
    const Eigen::Vector3d normal = t.rotation().transpose() * plane.normal;
    out.residual.head<3>() = weight * (normal - normal_);
    out.residual[3] = weight * (plane.signed_distance(t.translation()) - distance_);
    if (!with_jacobians) return true;
    const Eigen::Matrix<double, 3, 2> basis = tangent_basis(plane.normal);
    out.jacobians[0].setZero();
    out.jacobians[0].topRightCorner<3, 3>() = weight * skew(normal);
    out.jacobians[0].bottomLeftCorner<1, 3>() = weight * normal.transpose();
    out.jacobians[1].setZero();
    out.jacobians[1].topLeftCorner<3, 2>() = weight * t.rotation().transpose() * basis;
    out.jacobians[1].bottomLeftCorner<1, 2>() = weight * (t.translation() - plane.anchor).transpose() * basis;
    out.jacobians[1](3, 2) = weight;
    return true;
  }

 private:
  static constexpr double weight = 100;
  Eigen::Vector3d normal_;
  double distance_;
};

// A centroid is the mean of others: touches as many variables as it is given.
class MeanOf final : public DenseFactor {
 public:
  explicit MeanOf(std::vector<VariableRef> mean_then_parts) : DenseFactor(std::move(mean_then_parts), 3) {}

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const std::size_t parts = variables().size() - 1;
    const double share = 1.0 / static_cast<double>(parts);
    Eigen::Vector3d residual = values.centroid(variables()[0].index);
    for (std::size_t i = 1; i <= parts; ++i) residual -= share * values.centroid(variables()[i].index);
    out.residual = residual;
    if (!with_jacobians) return true;
    out.jacobians[0].setIdentity();
    for (std::size_t i = 1; i <= parts; ++i) out.jacobians[i] = -share * Eigen::Matrix3d::Identity();
    return true;
  }
};

class Silent final : public DenseFactor {
 public:
  Silent() : DenseFactor({{VariableKind::pose, 0}}, 1) {}
  bool evaluate(const VariableValues&, bool, FactorRows&) const override { return false; }
};

AnchoredPlane random_plane(Rng& rng) {
  return {Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized(),
          3 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()), 0.0};
}

std::unique_ptr<PlaneSeen> sees(const BundleProblem& p, int pose, int plane, Huber robust = {}) {
  const Se3& t = p.poses[static_cast<std::size_t>(pose)];
  const AnchoredPlane& truth = p.structures.planes[static_cast<std::size_t>(plane)];
  return std::make_unique<PlaneSeen>(pose, plane, t.rotation().transpose() * truth.normal,
                                     truth.signed_distance(t.translation()), robust);
}

TEST(DenseFactors, TestFactorHasTheRightJacobians) {
  Rng rng(1, "dense_factors_test", 0);
  const std::vector<Se3> poses{Se3::exp(random_tangent(rng, 1, 1))};
  StructureVariables structures;
  structures.planes = {random_plane(rng)};
  const PlaneSeen factor(0, 0, Eigen::Vector3d::UnitZ(), 1);
  FactorRows rows;
  factor.resize(rows);
  ASSERT_TRUE(factor.evaluate({poses, structures}, true, rows));
  const auto residual = [&](const Se3& pose, const AnchoredPlane& plane) -> Eigen::VectorXd {
    StructureVariables moved;
    moved.planes = {plane};
    const std::vector<Se3> at{pose};
    FactorRows out;
    factor.resize(out);
    factor.evaluate({at, moved}, false, out);
    return out.residual;
  };
  expect_jacobian(
      rows.jacobians[0],
      [&](const Eigen::VectorXd& d) { return residual(poses[0].retract(d), structures.planes[0]); }, 1e-7,
      1e-3);
  expect_jacobian(
      rows.jacobians[1],
      [&](const Eigen::VectorXd& d) { return residual(poses[0], structures.planes[0].retract(d)); }, 1e-7,
      1e-3);
}

// Poses and planes of a room, all disturbed but the first pose: planes seen from several poses restore both.
class RoomOfPlanes : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    Rng rng(2, "dense_factors_test", 0);
    for (int i = 0; i < 12; ++i) {
      problem.poses.push_back(Se3::exp(random_tangent(rng, 1, 0.5)));
      problem.pose_fixed.push_back(i == 0);
    }
    for (int p = 0; p < 6; ++p) problem.structures.planes.push_back(random_plane(rng));
    for (int i = 0; i < 12; ++i) {
      for (int p = 0; p < 6; ++p) problem.factors.push_back(sees(problem, i, p));
    }
    truth_poses = problem.poses;
    truth_planes = problem.structures.planes;
    for (int i = 1; i < 12; ++i) problem.poses[i] = problem.poses[i].retract(random_tangent(rng, 0.1, 0.05));
    for (auto& plane : problem.structures.planes)
      plane = plane.retract({0.1 * rng.normal(), 0.1 * rng.normal(), 0.1});
    options.max_iterations = 20;
    options.max_dense_poses = GetParam();
  }
  BundleProblem problem;
  BundleOptions options;
  std::vector<Se3> truth_poses;
  std::vector<AnchoredPlane> truth_planes;
};

TEST_P(RoomOfPlanes, PlanesAndPosesAreFoundTogether) {
  const SolveReport report = solve_bundle(problem, options);
  EXPECT_LT(report.final_cost, 1e-12 * report.initial_cost);
  for (std::size_t i = 0; i < truth_poses.size(); ++i) {
    EXPECT_LT((truth_poses[i].inverse() * problem.poses[i]).log().norm(), 1e-6);
  }
  for (std::size_t p = 0; p < truth_planes.size(); ++p) {
    EXPECT_LT(truth_planes[p].local(problem.structures.planes[p]).norm(), 1e-6);
    EXPECT_EQ(truth_planes[p].anchor, problem.structures.planes[p].anchor);
  }
}

TEST_P(RoomOfPlanes, FixedStructureHoldsAndRobustFactorsYield) {
  problem.structures.planes = truth_planes;
  problem.structures.plane_fixed = {1, 1, 1, 1, 1, 1};
  problem.pose_fixed.assign(12, 0);
  options.max_iterations = 60;
  const std::vector<Se3> start = problem.poses;
  const auto worst_with_wrong_sightings = [&](Huber robust) {
    problem.poses = start;
    problem.factors.resize(72);
    for (int i = 0; i < 6; ++i) {
      problem.factors.push_back(std::make_unique<PlaneSeen>(i, i, Eigen::Vector3d::UnitX(), 7, robust));
    }
    solve_bundle(problem, options);
    double worst = 0;
    for (std::size_t i = 0; i < 12; ++i) {
      worst = std::max(worst, (truth_poses[i].inverse() * problem.poses[i]).log().norm());
    }
    return worst;
  };
  EXPECT_LT(worst_with_wrong_sightings({1}), 0.05);
  EXPECT_GT(worst_with_wrong_sightings({}), 0.5);
  for (std::size_t p = 0; p < 6; ++p) EXPECT_EQ(problem.structures.planes[p].normal, truth_planes[p].normal);
}

TEST_P(RoomOfPlanes, StructureAndLandmarksShareOneProblem) {
  // Landmarks seen in pixels from poses 0..3 only: the planes carry the others.
  Rng rng(3, "dense_factors_test", 0);
  SyntheticWindowOptions exact;
  exact.noise = false;
  for (int l = 0; l < 60; ++l) {
    const Eigen::Vector3d p =
        truth_poses[0] * problem.intrinsics.unproject(rng.uniform(50, 600), rng.uniform(50, 400), 4);
    problem.landmarks.push_back(p + Eigen::Vector3d::Constant(0.02));
    for (int i = 0; i < 4; ++i) {
      if ((truth_poses[i].inverse() * p).z() < 0.5) continue;
      auto o = observe(problem.intrinsics, truth_poses[i], p, exact, rng);
      o.pose = i;
      o.landmark = l;
      problem.observations.push_back(o);
    }
  }
  const SolveReport report = solve_bundle(problem, options);
  EXPECT_LT(report.final_cost, 1e-3);
  for (std::size_t i = 0; i < truth_poses.size(); ++i) {
    EXPECT_LT((truth_poses[i].inverse() * problem.poses[i]).log().norm(), 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(DenseAndSparse, RoomOfPlanes, ::testing::Values(150, 0));

TEST(DenseFactors, CentroidsFollowWhatTheyHangOnWithoutForce) {
  BundleProblem problem;
  problem.structures.centroids = {{9, 9, 9}, {0, 0, 0}, {2, 0, 0}, {4, 3, 0}};
  problem.structures.centroid_fixed = {0, 1, 1, 1};
  std::vector<VariableRef> variables;
  for (int i = 0; i < 4; ++i) variables.push_back({VariableKind::centroid, i});
  problem.factors.push_back(std::make_unique<MeanOf>(variables));
  BundleOptions options;
  options.max_iterations = 10;
  solve_bundle(problem, options);
  EXPECT_LT((problem.structures.centroids[0] - Eigen::Vector3d(2, 1, 0)).norm(), 1e-6);
  EXPECT_EQ(problem.structures.centroids[3], Eigen::Vector3d(4, 3, 0));
}

TEST(DenseFactors, FactorsThatSayNothingCostNothing) {
  BundleProblem problem;
  problem.poses.resize(1);
  problem.factors.push_back(std::make_unique<Silent>());
  const SolveReport report = solve_bundle(problem);
  EXPECT_EQ(report.final_cost, 0);
  EXPECT_EQ(problem.poses[0].matrix(), Se3().matrix());
}

TEST(DenseFactors, APriorHoldsTheGaugeOfAFreeWindow) {
  SyntheticWindowOptions options;
  options.fixed_poses = 0;
  options.free_poses = 6;
  options.landmarks = 200;
  SyntheticWindow w = synthetic_window(options);
  w.problem.factors.push_back(std::make_unique<PosePrior>(VariableRef{VariableKind::pose, 2}, w.true_poses[2],
                                                          1e4 * Matrix6d::Identity()));
  BundleOptions solve;
  solve.max_iterations = 15;
  solve_bundle(w.problem, solve);
  EXPECT_LT((w.true_poses[2].inverse() * w.problem.poses[2]).log().norm(), 1e-5);
  EXPECT_LT((w.true_poses[5].inverse() * w.problem.poses[5]).log().norm(), 0.02);
}

}  // namespace
}  // namespace vsgraphs
