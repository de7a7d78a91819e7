// Markers, rooms and floors in the joint problem.
#include <gtest/gtest.h>

#include "core/base/rng.h"
#include "core/solve/bundle_adjustment.h"
#include "core/solve/factors/floor_centroid.h"
#include "core/solve/factors/plane_prior.h"
#include "core/solve/factors/relative_pose.h"
#include "core/solve/factors/room_centroid.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

TEST(Markers, SeenFromSeveralPosesRestoreBoth) {
  Rng rng(1, "structure_solve_test", 0);
  BundleProblem problem;
  std::vector<Se3> poses, markers;
  for (int m = 0; m < 4; ++m) markers.push_back(Se3::exp(random_tangent(rng, 2, 0.8)));
  for (int i = 0; i < 8; ++i) poses.push_back(camera_on_arc(0.2 * i));
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 2; ++k) {  // two markers in view, one of them in the next view too
      const int m = (i + k) % 4;
      problem.factors.push_back(std::make_unique<RelativePose>(
          VariableRef{VariableKind::pose, i}, VariableRef{VariableKind::marker, m},
          poses[static_cast<std::size_t>(i)].inverse() * markers[static_cast<std::size_t>(m)],
          100 * Matrix6d::Identity()));
    }
    problem.poses.push_back(poses[static_cast<std::size_t>(i)].retract(random_tangent(rng, 0.1, 0.05)));
  }
  problem.poses[0] = poses[0];
  problem.pose_fixed = {1, 0, 0, 0, 0, 0, 0, 0};
  for (const Se3& m : markers) problem.structures.markers.push_back(m.retract(random_tangent(rng, 0.2, 0.1)));
  BundleOptions options;
  options.max_iterations = 30;
  solve_bundle(problem, options);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_LT((poses[i].inverse() * problem.poses[i]).log().norm(), 1e-6) << "pose " << i;
  for (std::size_t m = 0; m < markers.size(); ++m)
    EXPECT_LT((markers[m].inverse() * problem.structures.markers[m]).log().norm(), 1e-6) << "marker " << m;
}

TEST(Centroids, FollowTheWallsAndExertNoForceOnThem) {
  BundleProblem problem;
  const auto build = [&](bool centroids) {
    problem = BundleProblem{};
    std::vector<WallOfRoom> walls[2];
    for (int w = 0; w < 8; ++w) {
      const double turn = 1.5708 * w;
      const Eigen::Vector3d inward(-std::cos(turn), 0, -std::sin(turn));
      const Eigen::Vector3d centre = Eigen::Vector3d(w < 4 ? 12 : 17, 1, 22) - 2 * inward;
      const AnchoredPlane wall{inward, centre, 0};
      problem.structures.planes.push_back(wall.retract({0.05, -0.03, 0.1}));
      problem.factors.push_back(
          std::make_unique<PlanePrior>(w, PlaneEstimate{wall, 1e4 * Eigen::Matrix3d::Identity()}));
      walls[w / 4].push_back({w, centre});
    }
    if (!centroids) return;
    problem.structures.centroids = {{5, 5, 5}, {0, 0, 0}, {-9, 0, 0}};
    for (int room = 0; room < 2; ++room)
      problem.factors.push_back(std::make_unique<RoomCentroid>(room, walls[room]));
    const int rooms[] = {0, 1};
    problem.factors.push_back(std::make_unique<FloorCentroid>(2, rooms));
  };
  BundleOptions options;
  options.max_iterations = 30;
  options.relative_tolerance = 0;
  build(false);
  solve_bundle(problem, options);
  const std::vector<AnchoredPlane> alone = problem.structures.planes;
  build(true);
  const SolveReport report = solve_bundle(problem, options);
  EXPECT_LT(report.final_cost, 1e-9);
  for (std::size_t w = 0; w < alone.size(); ++w)
    EXPECT_LT(alone[w].local(problem.structures.planes[w]).norm(), 1e-6);
  EXPECT_LT((problem.structures.centroids[0] - Eigen::Vector3d(12, 1, 22)).norm(), 1e-5);
  EXPECT_LT((problem.structures.centroids[1] - Eigen::Vector3d(17, 1, 22)).norm(), 1e-5);
  EXPECT_LT((problem.structures.centroids[2] - Eigen::Vector3d(14.5, 1, 22)).norm(), 1e-5);
}

}  // namespace
}  // namespace vsgraphs
