#include "simulate/camera_path.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vsgraphs {
namespace {

constexpr double pi = std::numbers::pi;

PathPlan steady() {
  PathPlan plan;
  plan.shake = 0;
  plan.speed = 0.5;
  plan.turn_rate = 30;
  return plan;
}

TEST(CameraPath, StartsAndEndsAtRestAtItsWaypoints) {
  const CameraPath path(steady(), {{{0, 0, 1.3}, 0, 0, 0}, {{2, 0, 1.3}, pi / 2, 0, 0}}, 1);
  const Se3 first = path.world_from_camera(0), last = path.world_from_camera(path.duration_s());
  EXPECT_LT((first.translation() - Eigen::Vector3d(0, 0, 1.3)).norm(), 0.02);
  EXPECT_LT((last.translation() - Eigen::Vector3d(2, 0, 1.3)).norm(), 0.02);
  // Camera axes: z forward, y down.
  EXPECT_GT(first.rotation().col(2).x(), 0.999);
  EXPECT_GT(last.rotation().col(2).y(), 0.999);
  EXPECT_LT(first.rotation().col(1).z(), -0.999);
  EXPECT_LT((path.world_from_camera(0.02).translation() - first.translation()).norm(), 1e-3);
}

TEST(CameraPath, KeepsToWalkingSpeedAndTurnRate) {
  const PathPlan plan = steady();
  const CameraPath path(plan, {{{0, 0, 1.3}, 0, 0, 0}, {{3, 0, 1.3}, 0.3, 0, 0}, {{3, 0.1, 1.3}, 2.5, 0, 0}},
                        1);
  const double dt = 0.01;
  double fastest = 0, fastest_turn = 0;
  for (double t = 0; t + dt < path.duration_s(); t += dt) {
    const Se3 a = path.world_from_camera(t), b = path.world_from_camera(t + dt);
    fastest = std::max(fastest, (b.translation() - a.translation()).norm() / dt);
    fastest_turn = std::max(fastest_turn, rotation_angle(a.rotation().transpose() * b.rotation()) / dt);
  }
  EXPECT_LT(fastest, 1.001 * plan.speed);
  EXPECT_GT(fastest, 0.95 * plan.speed);
  EXPECT_LT(fastest_turn, 1.001 * plan.turn_rate * pi / 180);
}

TEST(CameraPath, MovesWithoutJerks) {
  PathPlan plan = steady();
  plan.shake = 1;
  const CameraPath path(plan, {{{0, 0, 1.3}, 0, 0, 0}, {{1, 0, 1.3}, 1, 0, 0}, {{1, 1, 1.3}, 2, 0, 0}}, 7);
  // A jump anywhere would show as an acceleration far beyond the ~1 m/s^2 of a hand.
  const double dt = 1e-3;
  for (double t = dt; t + dt < path.duration_s(); t += 0.013) {
    const Eigen::Vector3d a = path.world_from_camera(t - dt).translation(),
                          b = path.world_from_camera(t).translation(),
                          c = path.world_from_camera(t + dt).translation();
    EXPECT_LT((a + c - 2 * b).norm() / (dt * dt), 3.0) << t;
  }
}

TEST(CameraPath, TurnsTheShortWayRound) {
  const CameraPath path(steady(), {{{0, 0, 1.3}, 3.0, 0, 0}, {{0.1, 0, 1.3}, -3.0, 0, 0}}, 1);
  for (double t = 0; t < path.duration_s(); t += 0.05)
    EXPECT_LT(path.world_from_camera(t).rotation().col(2).x(), -0.98) << t;  // never through yaw 0
}

TEST(CameraPath, ClosedPathsComeBack) {
  PathPlan plan = steady();
  plan.closed = true;
  const CameraPath path(plan, {{{0, 0, 1.3}, 0, 0, 0}, {{1, 0, 1.3}, 2, 0, 0}, {{1, 1, 1.3}, 4, 0, 0}}, 1);
  const Se3 back = path.world_from_camera(0).inverse() * path.world_from_camera(path.duration_s());
  EXPECT_LT(back.translation().norm(), 0.03);
  EXPECT_LT(rotation_angle(back.rotation()), 0.03);
}

TEST(CameraPath, ShakeIsSmallAndSeeded) {
  PathPlan plan = steady();
  plan.shake = 1;
  const std::vector<ViewPoint> points{{{0, 0, 1.3}, 0, 0, 0}, {{4, 0, 1.3}, 0, 0, 0}};
  const CameraPath a(plan, points, 1), again(plan, points, 1), b(plan, points, 2), still(steady(), points, 1);
  const Se3 pa = a.world_from_camera(3.3);
  EXPECT_EQ(pa.matrix(), again.world_from_camera(3.3).matrix());
  EXPECT_NE(pa.matrix(), b.world_from_camera(3.3).matrix());
  const Se3 difference = still.world_from_camera(3.3).inverse() * pa;
  EXPECT_LT(difference.translation().norm(), 0.03);
  EXPECT_LT(rotation_angle(difference.rotation()), 0.05);
}

TEST(CameraPath, KnowsWhichWaypointItHasPassed) {
  const CameraPath path(steady(), {{{0, 0, 1.3}, 0, 0, 0}, {{1, 0, 1.3}, 0, 0, 0}, {{3, 0, 1.3}, 0, 0, 0}},
                        1);
  EXPECT_EQ(path.waypoint_before(0), 0);
  EXPECT_EQ(path.waypoint_before(0.5 * path.duration_s()), 1);
  EXPECT_EQ(path.waypoint_before(path.duration_s()), 2);
  EXPECT_EQ(path.frame_count(10), static_cast<int>(path.duration_s() * 10) + 1);
}

}  // namespace
}  // namespace vsgraphs
