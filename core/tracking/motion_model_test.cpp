#include "core/tracking/motion_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vsgraphs {
namespace {

Vector6d twist() { return (Vector6d() << 0.3, -0.1, 0.2, 0.05, 0.4, -0.1).finished(); }

const Matrix6d well_known = 1e10 * Matrix6d::Identity();

double gap(const Se3& a, const Se3& b) { return (a.inverse() * b).log().norm(); }

TEST(MotionModel, StandsStillUntilItKnowsBetter) {
  MotionModel motion;
  const Se3 pose = Se3::exp(twist());
  EXPECT_FALSE(motion.known());
  EXPECT_LT(gap(motion.predict(pose, 0.1), pose), 1e-12);
}

TEST(MotionModel, ConstantVelocityWhateverTheTimeBetweenFrames) {
  const Se3 start = Se3::exp((Vector6d() << 1, 2, 3, 0.3, -0.2, 0.1).finished());
  const Se3 then = start * Se3::exp(0.1 * twist());
  MotionModel motion;
  motion.update(start, then, 0.1, well_known);
  EXPECT_LT(gap(motion.predict(then, 0.1), start * Se3::exp(0.2 * twist())), 1e-6);
  EXPECT_LT(gap(motion.predict(then, 0.4), start * Se3::exp(0.5 * twist())), 1e-6);
}

TEST(MotionModel, BelievesAVelocityForHalfASecond) {
  MotionModel motion;
  motion.update(Se3{}, Se3::exp(0.1 * twist()), 0.1, well_known);
  EXPECT_LT(gap(motion.predict(Se3{}, 20.0), Se3::exp(0.5 * twist())), 1e-6);
}

TEST(MotionModel, StampsThatDoNotAdvanceTeachNothing) {
  MotionModel motion;
  motion.update(Se3{}, Se3::exp(twist()), 0.0, well_known);
  motion.update(Se3{}, Se3::exp(twist()), -1.0, well_known);
  EXPECT_FALSE(motion.known());
}

TEST(MotionModel, ForgetsWhenTold) {
  MotionModel motion;
  motion.update(Se3{}, Se3::exp(twist()), 1.0, well_known);
  EXPECT_TRUE(motion.known());
  motion.forget();
  EXPECT_FALSE(motion.known());
  EXPECT_EQ(gap(motion.predict(Se3{}, 0.1), Se3{}), 0);
}

TEST(MotionModel, VelocityFadesWhereNothingMeasuresIt) {
  Vector6d moving = Vector6d::Zero();
  moving[0] = 0.5;
  MotionModel motion;
  motion.update(Se3{}, Se3::exp(0.1 * moving), 0.1, well_known);
  Matrix6d along_x_unknown = well_known;
  along_x_unknown(0, 0) = 0;
  Se3 pose;
  // A pose that jitters along x by more than it moves there.
  for (int i = 0; i < 200; ++i) {
    Vector6d step = Vector6d::Zero();
    step[0] = i % 2 == 0 ? 0.2 : 0.1;
    step[1] = 0.02;
    const Se3 next = pose * Se3::exp(step);
    motion.update(pose, next, 0.1, along_x_unknown);
    pose = next;
  }
  const Vector6d velocity = (pose.inverse() * motion.predict(pose, 0.1)).log() / 0.1;
  EXPECT_LT(std::abs(velocity[0]), 0.02) << "twenty seconds unmeasured: at rest";
  EXPECT_NEAR(velocity[1], 0.2, 1e-9) << "measured: followed";
}

TEST(MotionModel, AVelocityFromNoisyPosesIsSmoothedAndASharpOneFollowed) {
  // At rest, each pose off by 5 mm; then the same steps known to a tenth of a millimetre.
  const auto last_velocity = [](double sigma_m) {
    MotionModel motion;
    Se3 pose;
    for (int i = 0; i < 60; ++i) {
      Vector6d step = Vector6d::Zero();
      step[2] = i % 2 == 0 ? 0.005 : -0.005;
      const Se3 next = pose * Se3::exp(step);
      motion.update(pose, next, 1.0 / 30, Matrix6d::Identity() / (sigma_m * sigma_m));
      pose = next;
    }
    return std::abs(motion.predict(Se3{}, 0.1).translation().z()) / 0.1;
  };
  EXPECT_LT(last_velocity(0.005), 0.07) << "of 0.15 m/s between two frames";
  EXPECT_GT(last_velocity(0.0001), 0.14);
}

TEST(MotionModel, TheJumpThatEndsAStretchOfPredictionsIsNoVelocity) {
  Matrix6d height_unknown = 1e6 * Matrix6d::Identity();
  height_unknown(1, 1) = 0;
  MotionModel motion;
  Se3 pose;
  for (int i = 0; i < 30; ++i) motion.update(pose, pose, 1.0 / 30, height_unknown);
  Vector6d jump = Vector6d::Zero();
  jump[1] = 0.08;
  motion.update(pose, pose * Se3::exp(jump), 1.0 / 30, 1e6 * Matrix6d::Identity());
  EXPECT_LT(motion.predict(Se3{}, 1.0 / 30).translation().norm(), 0.002);
}

}  // namespace
}  // namespace vsgraphs
