#include "core/system/run/background_adjustment.h"

#include <gtest/gtest.h>

#include "core/base/bounded_queue.h"
#include "core/loops/test_loop_world.h"

namespace vsgraphs {
namespace {

class BackgroundAdjustmentTest : public ::testing::Test {
 protected:
  BackgroundAdjustmentTest() : world_(options()), snapshot_(world_.map.snapshot()) {}
  static test::LoopWorldOptions options() {
    test::LoopWorldOptions o;
    o.keyframes = 8;
    o.grids = o.patches = false;
    return o;
  }
  std::shared_ptr<FullAdjustment> of_this_map(int iterations = 5) const {
    return std::make_shared<FullAdjustment>(snapshot_,
                                            MeasurementModel{world_.camera, world_.pyramid.factor, {}},
                                            BundleOptions{.max_iterations = iterations});
  }

  test::LoopWorld world_;
  Snapshot snapshot_;
  BoundedQueue<int> done_{4};
  BackgroundAdjustment background_{[this] { done_.try_push(1); }};
};

TEST_F(BackgroundAdjustmentTest, ComesToWhatItComesToInTheForeground) {
  const auto beside = of_this_map(), here = of_this_map();
  EXPECT_FALSE(background_.has_finished(beside));
  background_.work_on(beside, 7);
  EXPECT_EQ(done_.pop(), 1) << "who waits is told";
  EXPECT_TRUE(background_.has_finished(beside));
  EXPECT_FALSE(background_.has_finished(here)) << "that is another one";
  EXPECT_FALSE(background_.has_finished(nullptr));
  here->run();
  EXPECT_EQ(beside->edit().hash(), here->edit().hash());
  background_.work_on(nullptr, 0);
  ASSERT_EQ(background_.spans().spans().size(), 1U);
  EXPECT_STREQ(background_.spans().spans()[0].name, "full_adjustment");
  EXPECT_EQ(background_.spans().spans()[0].frame, 7);
}

TEST_F(BackgroundAdjustmentTest, AnotherOneWantedStopsTheFirst) {
  // Pulled off so far that it would go on for long.
  world_.map.apply(
      MoveKeyframe{world_.ids[3], world_.truth[3].retract((Vector6d() << 1, 2, 1, 1, 1, 1).finished())});
  snapshot_ = world_.map.snapshot();
  const auto first = of_this_map(1'000'000), second = of_this_map();
  background_.work_on(first, 0);
  background_.work_on(second, 0);
  background_.work_on(second, 0);  // is under way already
  background_.wait();
  EXPECT_TRUE(background_.has_finished(second));
  EXPECT_FALSE(background_.has_finished(first));
  EXPECT_EQ(done_.size(), 1U) << "the first one never came to its end";
}

TEST_F(BackgroundAdjustmentTest, GivenUpEndsWithoutAResult) {
  world_.map.apply(
      MoveKeyframe{world_.ids[3], world_.truth[3].retract((Vector6d() << 1, 2, 1, 1, 1, 1).finished())});
  snapshot_ = world_.map.snapshot();
  const auto endless = of_this_map(1'000'000);
  background_.work_on(endless, 0);
  background_.give_up();
  background_.wait();
  EXPECT_FALSE(background_.has_finished(endless));
  EXPECT_EQ(done_.size(), 0U);
}

TEST_F(BackgroundAdjustmentTest, WhatFailsIsThrownWhereItIsAskedFor) {
  const auto impossible = of_this_map(-1);
  background_.work_on(impossible, 0);
  EXPECT_EQ(done_.pop(), 1);
  EXPECT_THROW(background_.has_finished(impossible), std::exception);
}

}  // namespace
}  // namespace vsgraphs
