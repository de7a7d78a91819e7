#include "core/tracking/loss_timer.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

TrackerOptions limits() {
  TrackerOptions options;
  options.coast_s = 0.5;
  options.coast_frames = 2;
  options.new_map_after_s = 3;
  return options;
}

TEST(LossTimer, CoastsForAMoment) {
  LossTimer timer(limits());
  timer.measured(10);
  for (int i = 1; i <= 5; ++i) EXPECT_TRUE(timer.coasts(10 + 0.1 * i)) << i;
  EXPECT_FALSE(timer.coasts(10.6));
  EXPECT_FALSE(timer.lost()) << "whoever asks decides";
}

TEST(LossTimer, HoweverSlowTheFramesAFewAreCoasted) {
  LossTimer timer(limits());
  timer.measured(10);
  EXPECT_TRUE(timer.coasts(20));
  EXPECT_TRUE(timer.coasts(30));
  EXPECT_FALSE(timer.coasts(40));
}

TEST(LossTimer, AMeasurementBeginsAnew) {
  LossTimer timer(limits());
  for (int i = 0; i < 3; ++i) timer.coasts(10 + i);
  timer.lose();
  EXPECT_TRUE(timer.lost());
  timer.measured(20);
  EXPECT_FALSE(timer.lost());
  EXPECT_TRUE(timer.coasts(25));
  EXPECT_TRUE(timer.coasts(26));
  EXPECT_FALSE(timer.coasts(27));
}

TEST(LossTimer, SearchesFromTheFirstFrameThatSeesEnough) {
  LossTimer timer(limits());
  timer.measured(0);
  timer.lose();
  EXPECT_FALSE(timer.searched_in_vain(100)) << "what lies before was dark";
  EXPECT_FALSE(timer.searched_in_vain(102.9));
  EXPECT_TRUE(timer.searched_in_vain(103));
  timer.measured(104);
  EXPECT_FALSE(timer.searched_in_vain(110)) << "found in between";
}

}  // namespace
}  // namespace vsgraphs
