#include "core/loops/loop_adjustment.h"

#include <gtest/gtest.h>

#include "core/loops/test_loop_world.h"

namespace vsgraphs {
namespace {

class FullAdjustmentTest : public ::testing::Test {
 protected:
  FullAdjustmentTest() : world_(options()) {
    Rng rng(1, "full_adjustment", 0);
    for (std::size_t k = 1; k < world_.ids.size(); ++k) {
      Vector6d noise;
      for (int i = 0; i < 6; ++i) noise[i] = 0.01 * rng.normal();
      world_.map.apply(MoveKeyframe{world_.ids[k], world_.truth[k].retract(noise)});
    }
    snapshot_ = world_.map.snapshot();
  }
  static test::LoopWorldOptions options() {
    test::LoopWorldOptions o;
    o.keyframes = 8;
    o.grids = o.patches = false;
    return o;
  }
  double worst_error_m(const Map& map) const {
    double worst = 0;
    for (int k = 0; k < static_cast<int>(world_.ids.size()); ++k)
      worst = std::max(worst, world_.error_m(map, k));
    return worst;
  }

  test::LoopWorld world_;
  MeasurementModel model_{world_.camera, world_.pyramid.factor, {}};
  Snapshot snapshot_;
};

TEST_F(FullAdjustmentTest, HoldsEveryKeyframeAndLandmark) {
  const Window window = whole_map(*snapshot_);
  EXPECT_EQ(window.fixed.size(), 1U);
  EXPECT_EQ(window.free.size() + 1, snapshot_->keyframes().size());
  EXPECT_EQ(window.landmarks.size() + window.passengers.size(), snapshot_->landmarks().size());
  EXPECT_FALSE(window.passengers.empty());
}

TEST_F(FullAdjustmentTest, BringsTheMapToTheTruth) {
  EXPECT_GT(worst_error_m(*snapshot_), 0.01);
  FullAdjustment adjustment(snapshot_, model_);
  EXPECT_TRUE(adjustment.run());
  EXPECT_EQ(worst_error_m(*snapshot_), worst_error_m(world_.map))
      << "nothing is written before the edit is applied";
  world_.map.apply(adjustment.edit());
  EXPECT_LT(worst_error_m(world_.map), 0.001);
}

TEST_F(FullAdjustmentTest, SaysWhereTheKeyframeStandsThatHeldAllOthers) {
  FullAdjustment adjustment(snapshot_, model_);
  EXPECT_TRUE(adjustment.run());
  const Se3 oldest = snapshot_->keyframes().find(world_.ids[0])->world_from_camera;
  world_.map.apply(MoveKeyframe{world_.ids[0], oldest.retract(Vector6d::Constant(0.01))});
  world_.map.apply(adjustment.edit());
  EXPECT_LT(worst_error_m(world_.map), 0.001) << "though a window moved it meanwhile";
}

TEST_F(FullAdjustmentTest, StopsBetweenIterations) {
  FullAdjustment adjustment(snapshot_, model_);
  int asked = 0;
  EXPECT_FALSE(adjustment.run([&asked] { return ++asked > 2; }));
  EXPECT_EQ(adjustment.iterations(), 2);
}

TEST_F(FullAdjustmentTest, TakesOutObservationsThatAreWrong) {
  // Feature 5 of keyframe 3 shows another landmark than it says.
  const KeyframeId id = world_.ids[3];
  const std::vector<LandmarkId> seen = world_.map.keyframes().find(id)->landmarks;
  const LandmarkId a = seen[5], b = seen[40];
  world_.map.apply(RemoveObservation{a, id});
  world_.map.apply(RemoveObservation{b, id});
  world_.map.apply(AddObservation{a, {id, 40}});
  FullAdjustment adjustment(world_.map.snapshot(), model_);
  EXPECT_TRUE(adjustment.run());
  world_.map.apply(adjustment.edit());
  EXPECT_FALSE(world_.map.keyframes().find(id)->landmarks[40].valid());
  EXPECT_LT(worst_error_m(world_.map), 0.001);
}

TEST_F(FullAdjustmentTest, GivesTheSameBytesEveryTime) {
  FullAdjustment a(snapshot_, model_), b(snapshot_, model_);
  EXPECT_TRUE(a.run());
  EXPECT_TRUE(b.run());
  EXPECT_EQ(a.edit().hash(), b.edit().hash());
}

}  // namespace
}  // namespace vsgraphs
