#include "core/stages/motion_model.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

Vector6d twist() { return (Vector6d() << 0.3, -0.1, 0.2, 0.05, 0.4, -0.1).finished(); }

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
  motion.update(start, then, 0.1);
  EXPECT_LT(gap(motion.predict(then, 0.1), start * Se3::exp(0.2 * twist())), 1e-12);
  EXPECT_LT(gap(motion.predict(then, 0.4), start * Se3::exp(0.5 * twist())), 1e-12);
}

TEST(MotionModel, BelievesAVelocityForHalfASecond) {
  MotionModel motion;
  motion.update(Se3{}, Se3::exp(0.1 * twist()), 0.1);
  EXPECT_LT(gap(motion.predict(Se3{}, 20.0), Se3::exp(0.5 * twist())), 1e-12);
}

TEST(MotionModel, StampsThatDoNotAdvanceTeachNothing) {
  MotionModel motion;
  motion.update(Se3{}, Se3::exp(twist()), 0.0);
  motion.update(Se3{}, Se3::exp(twist()), -1.0);
  EXPECT_FALSE(motion.known());
}

TEST(MotionModel, ForgetsWhenTold) {
  MotionModel motion;
  motion.update(Se3{}, Se3::exp(twist()), 1.0);
  EXPECT_TRUE(motion.known());
  motion.forget();
  EXPECT_FALSE(motion.known());
  EXPECT_EQ(gap(motion.predict(Se3{}, 0.1), Se3{}), 0);
}

}  // namespace
}  // namespace vsgraphs
