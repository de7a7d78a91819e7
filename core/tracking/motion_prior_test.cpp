#include "core/tracking/motion_prior.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

TEST(MotionPrior, IsWorthTheLessTheLongerThePredictionReaches) {
  const Se3 predicted(so3_exp({0.1, 0, 0}), {1, 2, 3});
  const PosePriorTerm soon = motion_prior(predicted, 0), later = motion_prior(predicted, 0.1);
  EXPECT_TRUE(soon.world_from_camera.matrix() == predicted.matrix());
  EXPECT_TRUE(soon.information.isApprox(2500 * Matrix6d::Identity()));
  EXPECT_TRUE(later.information.isApprox(400 * Matrix6d::Identity()));
}

}  // namespace
}  // namespace vsgraphs
