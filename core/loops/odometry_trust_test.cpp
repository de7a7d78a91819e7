#include "core/loops/odometry_trust.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/base/rng.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using test::standing_at;

// A walk of keyframes with measured steps between them; the map has them where they truly stand.
class OdometryTrust : public ::testing::Test {
 protected:
  OdometryTrust() {
    Rng rng(1, "odometry_trust_test", 0);
    for (int k = 0; k < keyframes; ++k) {
      ids_.push_back(test::add_keyframe(map_, test::keyframe_seeing(Camera{}, at(k), {})));
      if (k == 0) continue;
      Vector6d noise;
      for (int i = 0; i < 6; ++i) noise[i] = (i < 3 ? sigma_m : sigma_rad) * rng.normal();
      Vector6d variances;
      variances.head<3>().setConstant(sigma_m * sigma_m);
      variances.tail<3>().setConstant(sigma_rad * sigma_rad);
      const Se3 step = (at(k - 1).inverse() * at(k)).retract(noise);
      map_.apply(SetOdometry{ids_.back(), {ids_[ids_.size() - 2], step, variances.asDiagonal()}});
    }
  }
  static Se3 at(int k) { return {so3_exp({0, 0.1 * k, 0}), {0.3 * k, 0, 0.05 * k}}; }
  // Each keyframe from `first` on is moved by so much more than the one before it.
  void bend(int first, int steps, const Vector6d& per_step) {
    Se3 bent;
    for (int k = first; k < keyframes; ++k) {
      if (k < first + steps) bent = bent * Se3::exp(per_step);
      map_.apply(MoveKeyframe{ids_[static_cast<std::size_t>(k)], bent * at(k)});
    }
  }
  std::vector<std::uint8_t> contradicted() const { return contradicted_steps(map_, {}); }
  int count() const {
    const auto steps = contradicted();
    return std::accumulate(steps.begin(), steps.end(), 0);
  }

  static constexpr int keyframes = 60;
  static constexpr double sigma_m = 0.005, sigma_rad = 0.0015;
  Map map_;
  std::vector<KeyframeId> ids_;
};

TEST_F(OdometryTrust, AMapThatAgreesIsBelieved) { EXPECT_EQ(count(), 0); }

// As a true loop takes back what 60 keyframes drifted.
TEST_F(OdometryTrust, ACorrectionWithinTheDriftIsBelieved) {
  bend(1, keyframes, (Vector6d() << 0.002, 0, 0.002, 0, 0.0005, 0).finished());
  EXPECT_EQ(count(), 0);
}

TEST_F(OdometryTrust, OneJumpIsFoundAndWhatIsFarFromItIsLeft) {
  bend(30, 1, (Vector6d() << 0.1, 0, 0, 0, 0, 0).finished());
  const auto steps = contradicted();
  EXPECT_EQ(steps[30], 1);
  EXPECT_EQ(steps[5], 0);
  EXPECT_EQ(steps[55], 0);
}

// Each step for itself is within its noise.
TEST_F(OdometryTrust, ABendSpreadOverManyStepsIsFound) {
  bend(10, 40, (Vector6d() << 0, 0, 0, 0, 0.006, 0).finished());
  EXPECT_GT(count(), 35);
}

TEST_F(OdometryTrust, NothingIsKnownAcrossAGap) {
  map_.apply(SetOdometry{ids_[30], {}});
  bend(30, 1, (Vector6d() << 7, 0, 0, 0, 1, 0).finished());
  EXPECT_EQ(count(), 0);
}

}  // namespace
}  // namespace vsgraphs
