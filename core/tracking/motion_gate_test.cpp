#include "core/tracking/motion_gate.h"

#include <gtest/gtest.h>

#include <limits>

namespace vsgraphs {
namespace {

Se3 moved(double x_m) { return {Eigen::Matrix3d::Identity(), {x_m, 0, 0}}; }
Se3 turned(double rad) { return {so3_exp({0, rad, 0}), Eigen::Vector3d::Zero()}; }

TrackerOptions limits() {
  TrackerOptions options;
  options.max_speed_m_per_s = 3;
  options.max_turn_rad_per_s = 5;
  options.max_velocity_change_m_per_s = 1;
  options.max_turn_change_rad_per_s = 2;
  return options;
}

TEST(MotionGate, ACameraIsOnlySoFast) {
  const MotionGate gate(limits(), moved(1), 0.5, {});
  EXPECT_TRUE(gate.passes(moved(1 + 1.59)));
  EXPECT_FALSE(gate.passes(moved(1 + 1.61)));
  EXPECT_FALSE(gate.passes(moved(1 - 1.61)));
}

TEST(MotionGate, AndTurnsOnlySoFast) {
  const MotionGate gate(limits(), {}, 0.2, {});
  EXPECT_TRUE(gate.passes(turned(1.14)));
  EXPECT_FALSE(gate.passes(turned(1.16)));
}

TEST(MotionGate, MoreTimeReachesFurther) {
  EXPECT_FALSE(MotionGate(limits(), {}, 0.1, {}).passes(moved(0.7)));
  EXPECT_TRUE(MotionGate(limits(), {}, 0.3, {}).passes(moved(0.7)));
}

TEST(MotionGate, WhereTheMotionIsKnownItCannotChangeAtOnce) {
  const MotionGate gate(limits(), {}, 0.1, moved(0.2));
  EXPECT_TRUE(gate.passes(moved(0.39)));
  EXPECT_FALSE(gate.passes(moved(-0.01))) << "slow enough, but it went the other way";
  EXPECT_TRUE(MotionGate(limits(), {}, 0.1, {}).passes(moved(-0.01)));
  const MotionGate turning(limits(), {}, 0.1, turned(0.3));
  EXPECT_TRUE(turning.passes(turned(0.3 + 0.34)));
  EXPECT_FALSE(turning.passes(turned(0.3 - 0.36)));
}

TEST(MotionGate, APredictionDoesNotMakeItFaster) {
  EXPECT_FALSE(MotionGate(limits(), {}, 0.1, moved(0.5)).passes(moved(0.5)));
}

TEST(MotionGate, WhatIsNoNumberIsNoPose) {
  EXPECT_FALSE(MotionGate(limits(), {}, 0.1, {}).passes(moved(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace vsgraphs
