#include "core/solve/pose_solver.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/solve/factors/reprojection.h"
#include "core/solve/pose_normal.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

const Intrinsics intrinsics;

Se3 disturbed(const Se3& pose, double metres, double radians, std::uint64_t seed = 3) {
  Rng rng(seed, "pose_solver_test", 0);
  return pose.retract(random_tangent(rng, metres, radians));
}

double distance(const Se3& a, const Se3& b) { return (a.inverse() * b).log().norm(); }

TEST(PoseRows, NormalEquationsAreThoseOfTheFactor) {
  SyntheticView view = synthetic_view(37, 5);
  view.observations[3].point_in_world = view.world_from_camera * Eigen::Vector3d(0, 0, -1);  // behind
  const Se3 pose = disturbed(view.world_from_camera, 0.02, 0.01);
  PoseNormal expected;
  for (const PoseObservation& o : view.observations) {
    const ReprojectionMeasurement m{o.u, o.v, o.inverse_depth, o.inv_sigma_px, o.inv_sigma_inverse_depth};
    const auto add = [&](const auto& rows, const Huber& huber) {
      const double squared = rows.residual.squaredNorm(), weight = huber.weight(squared);
      expected.h += weight * rows.by_pose.transpose() * rows.by_pose;
      expected.b -= weight * rows.by_pose.transpose() * rows.residual;
      expected.cost += 0.5 * huber.cost(squared);
    };
    ReprojectionRows<3> rows3;
    ReprojectionRows<2> rows2;
    if (o.has_depth() && reprojection(intrinsics, pose, o.point_in_world, m, rows3)) add(rows3, huber_3dof);
    if (!o.has_depth() && reprojection(intrinsics, pose, o.point_in_world, m, rows2)) add(rows2, huber_2dof);
  }
  PoseNormal actual;
  PoseRows(intrinsics, view.observations, {}).accumulate(pose, actual);
  EXPECT_TRUE(actual.h.isApprox(expected.h, 1e-11)) << actual.h - expected.h;
  EXPECT_TRUE(actual.b.isApprox(expected.b, 1e-11));
  const Huber huber = view.observations[3].has_depth() ? huber_3dof : huber_2dof;
  EXPECT_NEAR(actual.cost, expected.cost + 0.5 * huber.cost(1e4), 1e-9 * expected.cost);
}

TEST(PoseSolver, FindsTheExactPoseWithoutNoise) {
  const SyntheticView view = synthetic_view(200, 0, false);
  const PoseSolution s =
      solve_pose(intrinsics, disturbed(view.world_from_camera, 0.1, 0.05), view.observations);
  EXPECT_TRUE(s.converged);
  EXPECT_FALSE(s.degenerate);
  EXPECT_EQ(s.inliers, 200);
  EXPECT_LT(distance(s.world_from_camera, view.world_from_camera), 1e-5);  // observations are floats
}

TEST(PoseSolver, WithNoiseTheErrorIsWhatTheInformationSays) {
  double squares = 0;
  constexpr int runs = 60;
  for (int i = 0; i < runs; ++i) {
    const SyntheticView view = synthetic_view(200, 0, true, 100 + i);
    const PoseSolution s =
        solve_pose(intrinsics, disturbed(view.world_from_camera, 0.03, 0.02), view.observations);
    const Vector6d error = (view.world_from_camera.inverse() * s.world_from_camera).log();
    squares += error.dot(s.information * error);
    EXPECT_NEAR(s.mean_chi2, 0.9, 0.2);  // the gate cuts the tails of 1
  }
  EXPECT_NEAR(squares / runs, 6.0, 2.0);
}

TEST(PoseSolver, FortyPercentOfWrongMatchesAreFound) {
  for (int run = 0; run < 10; ++run) {
    const SyntheticView view = synthetic_view(300, 120, true, 200 + run);
    const PoseSolution s =
        solve_pose(intrinsics, disturbed(view.world_from_camera, 0.05, 0.03), view.observations);
    EXPECT_LT(distance(s.world_from_camera, view.world_from_camera), 0.01);
    int kept_wrong = 0;
    for (int i = 0; i < 120; ++i) kept_wrong += is_inlier(s.fit[i]);
    EXPECT_LE(kept_wrong, 3);
    EXPECT_GE(s.inliers, 160);
  }
}

TEST(PoseSolver, GatingFirstKeepsAGoodPoseAmongMostlyWrongMatches) {
  const SyntheticView view = synthetic_view(400, 340, true, 9, 0.9);
  PoseSolverOptions gated;
  gated.gate_first = true;
  const Se3 start = disturbed(view.world_from_camera, 0.002, 0.001);
  const PoseSolution s = solve_pose(intrinsics, start, view.observations, {}, {}, gated);
  EXPECT_LT(distance(s.world_from_camera, view.world_from_camera), 0.02);
  EXPECT_GE(s.inliers, 50);
}

TEST(PoseSolver, DepthThatDisagreesDemotesTheMatchToItsPixel) {
  SyntheticView view = synthetic_view(200, 0, true, 7, 1.0);
  for (int i = 0; i < 50; ++i) view.observations[i].inverse_depth *= 0.6;  // read the surface behind
  const PoseSolution s =
      solve_pose(intrinsics, disturbed(view.world_from_camera, 0.02, 0.01), view.observations);
  int demoted = 0;
  for (int i = 0; i < 50; ++i) demoted += s.fit[i] == ObservationFit::pixel_only;
  EXPECT_GE(demoted, 44);
  EXPECT_LT(distance(s.world_from_camera, view.world_from_camera), 0.01);
  EXPECT_LE(s.depth_inliers, s.inliers - demoted);
}

TEST(PoseSolver, PriorHoldsWhatIsNotSeenAndIsNotCountedAsSeen) {
  SyntheticView view = synthetic_view(2, 0, false, 5, 0.0);  // four numbers for six unknowns
  PosePriorTerm prior{view.world_from_camera, 1e4 * Matrix6d::Identity()};
  const Se3 start = disturbed(view.world_from_camera, 0.01, 0.005);
  const PoseSolution s = solve_pose(intrinsics, start, view.observations, {}, prior);
  EXPECT_TRUE(s.degenerate);
  EXPECT_LT(distance(s.world_from_camera, view.world_from_camera), 1e-4);
}

TEST(PoseSolver, PlanesHoldThePoseWhereThereAreNoFeatures) {
  const Se3 truth = Se3::exp((Vector6d() << 0.3, -0.2, 0.1, 0.2, 0.1, -0.3).finished());
  Rng rng(1, "planes", 0);
  std::vector<PointToPlane> rows;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d normal = Eigen::Vector3d::Unit(i % 3);
    Eigen::Vector3d point(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    point[i % 3] = 1.5;
    rows.push_back({truth.inverse() * point, normal, i < 20 ? -1.2 : -1.5, 100});  // the first lie off it
  }
  const PoseSolution s = solve_pose(intrinsics, disturbed(truth, 0.03, 0.02), {}, rows);
  EXPECT_LT(distance(s.world_from_camera, truth), 1e-6);
  EXPECT_EQ(s.plane_inliers, 280);
  EXPECT_FALSE(s.degenerate);
  // One wall alone leaves three directions open.
  std::vector<PointToPlane> wall;
  for (std::size_t i = 20; i < rows.size(); ++i)
    if (rows[i].normal_in_world.x() == 1) wall.push_back(rows[i]);
  EXPECT_TRUE(solve_pose(intrinsics, truth, {}, wall).degenerate);
}

TEST(PoseSolver, HopelessInputGivesAFinitePose) {
  const Se3 start = Se3::exp(Vector6d::Constant(0.1));
  const PoseSolution nothing = solve_pose(intrinsics, start, {});
  EXPECT_TRUE(nothing.world_from_camera.finite());
  EXPECT_TRUE(nothing.degenerate);
  EXPECT_EQ(nothing.inliers, 0);

  SyntheticView behind = synthetic_view(50, 0);
  for (auto& o : behind.observations) {
    o.point_in_world = behind.world_from_camera * Eigen::Vector3d(0.1, 0.1, -2);
  }
  const PoseSolution s = solve_pose(intrinsics, behind.world_from_camera, behind.observations);
  EXPECT_TRUE(s.world_from_camera.finite());
  EXPECT_TRUE(s.degenerate);
  EXPECT_EQ(s.inliers, 0);

  const SyntheticView single = synthetic_view(1, 0);
  EXPECT_TRUE(solve_pose(intrinsics, start, single.observations).world_from_camera.finite());
}

TEST(PoseSolver, TwiceTheSameBytes) {
  const SyntheticView view = synthetic_view(300, 60);
  const Se3 start = disturbed(view.world_from_camera, 0.05, 0.03);
  const PoseSolution a = solve_pose(intrinsics, start, view.observations);
  const PoseSolution b = solve_pose(intrinsics, start, view.observations);
  EXPECT_EQ(0, std::memcmp(&a.world_from_camera, &b.world_from_camera, sizeof(Se3)));
  EXPECT_EQ(a.fit, b.fit);
}

}  // namespace
}  // namespace vsgraphs
