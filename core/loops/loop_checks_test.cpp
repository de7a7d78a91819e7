#include "core/loops/loop_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/loops/test_loop_world.h"

namespace vsgraphs {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;

// 1 m x 1 m in the plane z = `z`, its middle at x = `x`, turned about its vertical middle line; faces the origin.
SightedPatch patch(double z, double x = 0, double turn_deg = 0, bool faces_away = false) {
  SightedPatch p;
  const Eigen::Matrix3d turn = so3_exp({0, turn_deg * rad_per_deg, 0});
  const Eigen::Vector3d middle(x, 0, z);
  p.plane = {turn * Eigen::Vector3d(0, 0, faces_away ? 1 : -1), middle, 0};
  for (int i = -5; i <= 5; ++i)
    for (int j = -5; j <= 5; ++j) p.points.push_back(middle + turn * Eigen::Vector3d(0.1 * i, 0.1 * j, 0));
  p.area_m2 = 1;
  return p;
}

struct Expectation {
  double agreeing, disagreeing;
};
void expect(const SightedPatch& moved, const std::vector<SightedPatch>& standing, Expectation e) {
  const SurfaceAgreement a = compare_surfaces({moved}, standing, {});
  EXPECT_EQ(a.agreeing_m2, e.agreeing);
  EXPECT_EQ(a.disagreeing_m2, e.disagreeing);
}

constexpr Expectation agrees{1, 0}, disagrees{0, 1}, says_nothing{0, 0};

TEST(LoopChecks, OneSurfaceAgreesWithItself) {
  expect(patch(3), {patch(3)}, agrees);
  expect(patch(3.05, 0.3), {patch(3, 0, 5)}, agrees);
}

TEST(LoopChecks, OffsetDisagrees) {
  expect(patch(3.25), {patch(3)}, disagrees);
  expect(patch(2.75), {patch(3)}, disagrees);
}

TEST(LoopChecks, AngleDisagreesUntilItIsACorner) {
  expect(patch(3, 0, 25), {patch(3)}, disagrees);
  expect(patch(3, 0, 90), {patch(3)}, says_nothing);
}

TEST(LoopChecks, FacingTheOtherWayInOnePlaceDisagrees) {
  expect(patch(3, 0, 0, true), {patch(3)}, disagrees);
  expect(patch(3.15, 0, 0, true), {patch(3)}, says_nothing);  // a wall's other face
}

TEST(LoopChecks, WhatOnlyOneSideSawSaysNothing) {
  expect(patch(3, 2), {patch(3)}, says_nothing);
  expect(patch(3.6), {patch(3)}, says_nothing);
  expect(patch(3), {}, says_nothing);
}

TEST(LoopChecks, CoincidingWithOneOfSeveralIsEnough) { expect(patch(3), {patch(3.3), patch(3)}, agrees); }

TEST(LoopChecks, AShareMayDisagree) {
  EXPECT_TRUE(surfaces_agree({2.0, 1.0}, {}));
  EXPECT_FALSE(surfaces_agree({1.0, 1.0}, {}));
  EXPECT_TRUE(surfaces_agree({0.0, 0.2}, {})) << "too little was compared";
}

TEST(LoopChecks, UprightWithinTheTolerance) {
  const std::optional<Eigen::Vector3d> up = Eigen::Vector3d(0, -1, 0);
  const auto turned = [](const Eigen::Vector3d& axis, double deg) {
    return Se3(so3_exp(deg * rad_per_deg * axis), Eigen::Vector3d(1, 2, 3));
  };
  EXPECT_TRUE(stays_upright(turned(Eigen::Vector3d::UnitX(), 4), up, up, {}));
  EXPECT_FALSE(stays_upright(turned(Eigen::Vector3d::UnitX(), 6), up, up, {}));
  EXPECT_FALSE(stays_upright(turned(Eigen::Vector3d::UnitZ(), -6), up, up, {}));
  EXPECT_TRUE(stays_upright(turned(Eigen::Vector3d::UnitY(), 120), up, up, {})) << "about the vertical";
  EXPECT_TRUE(stays_upright(turned(Eigen::Vector3d::UnitX(), 90), std::nullopt, up, {}));
}

class FreeSpace : public ::testing::Test {
 protected:
  static test::LoopWorldOptions options() {
    test::LoopWorldOptions o;
    o.keyframes = 3;
    o.patches = false;
    return o;
  }
  FreeSpaceCount count(const Se3& correction) const {
    return count_seen_through(world_.map, world_.camera, {world_.ids[0]}, correction, {world_.ids[2]});
  }
  test::LoopWorld world_{options()};
};

TEST_F(FreeSpace, IsFreeInTheRightPlace) {
  const FreeSpaceCount c = count(Se3{});
  EXPECT_GT(c.seen, 500);
  EXPECT_EQ(c.through, 0);
  EXPECT_TRUE(leaves_free_space_free(c, {}));
}

TEST_F(FreeSpace, AWallInItIsSeen) {
  const FreeSpaceCount c = count(test::standing_at(0, 0, -1));
  EXPECT_GT(c.through, c.seen / 2);
  EXPECT_FALSE(leaves_free_space_free(c, {}));
}

TEST_F(FreeSpace, WhatIsHiddenSaysNothing) {
  const FreeSpaceCount c = count(test::standing_at(0, 0, 1));
  EXPECT_EQ(c.through, 0);
  EXPECT_LT(c.seen, count(Se3{}).seen / 2);
}

TEST(LoopChecks, DriftIsMeasuredInItsOwnSigmas) {
  Drift drift;
  drift.covariance = 0.01 * Matrix6d::Identity();  // 0.1 m, 0.1 rad
  const Matrix6d sharp = 1e8 * Matrix6d::Identity();
  const Se3 mapped = test::standing_at(3);
  EXPECT_NEAR(drift_sigmas(mapped, test::standing_at(3.3), drift, sharp), 3.0, 1e-3);
  EXPECT_NEAR(drift_sigmas(mapped, mapped, drift, sharp), 0.0, 1e-9);
  // A blurred alignment excludes less.
  const Matrix6d blurred = 1e2 * Matrix6d::Identity();
  EXPECT_NEAR(drift_sigmas(mapped, test::standing_at(3.3), drift, blurred), 3.0 / std::sqrt(2.0), 1e-3);
}

TEST(LoopChecks, PatchesStandWhereTheirKeyframesDo) {
  test::LoopWorldOptions options;
  options.keyframes = 1;
  const test::LoopWorld world(options);
  const auto placed = placed_patches(world.map, world.ids, test::standing_at(0, 0, 2));
  ASSERT_FALSE(placed.empty());
  bool ahead = false;
  for (const SightedPatch& p : placed) {
    for (const Eigen::Vector3d& point : p.points) EXPECT_NEAR(p.plane.signed_distance(point), 0, 1e-3);
    ahead |= std::abs(p.plane.signed_distance({0, 0, 5})) < 1e-3 && p.plane.normal.z() < -0.99;
  }
  EXPECT_TRUE(ahead) << "the wall 3 m from the middle, moved by 2 m";
}

}  // namespace
}  // namespace vsgraphs
