#include "core/loops/loop_tally.h"

#include <gtest/gtest.h>

#include "core/loops/test_loop_world.h"

namespace vsgraphs {
namespace {

using test::LoopWorld;
using test::LoopWorldOptions;

LoopWorld another_room_that_looks_alike() {
  LoopWorldOptions options;
  options.second_room_at = {9, 0, 0};
  return LoopWorld(options);
}

TEST(LoopTally, TellsWhyALoopWasRefused) {
  LoopWorld world = another_room_that_looks_alike();
  LoopCloser closer({}, world.camera, world.pyramid, 1);
  LoopReport report;
  ASSERT_FALSE(closer.close(world.ids.back(), world.map.snapshot(), world.places, report, nullptr));
  LoopTally tally;
  tally.add(report, world.map, world.map);
  EXPECT_GE(tally.verdicts[static_cast<std::size_t>(LoopVerdict::beyond_drift)], 1);
  ASSERT_EQ(tally.nearest.size(), 1U);
  const RefusedLoop& refused = tally.nearest.front();
  EXPECT_EQ(refused.verdict, LoopVerdict::beyond_drift);
  EXPECT_EQ(refused.frame, world.map.keyframes().find(report.keyframe)->frame_index);
  EXPECT_EQ(refused.place_frame, world.map.keyframes().find(report.place)->frame_index);
  EXPECT_NEAR(refused.off_m, 9, 0.3);
  EXPECT_GT(refused.drift_sigmas, LoopCheckOptions{}.max_drift_sigmas);
  EXPECT_GT(refused.inliers, 50);
}

TEST(LoopTally, KeepsTheNearestMissesAndCountsAll) {
  LoopWorld world = another_room_that_looks_alike();
  LoopReport report;
  report.keyframe = world.ids[30];
  report.place = world.ids[0];
  LoopTally tally;
  for (int i = 0; i < 30; ++i) {
    report.verdict = i % 2 ? LoopVerdict::tilted : LoopVerdict::unsupported;
    report.inliers = i;
    report.attempts = {};
    report.attempts[static_cast<std::size_t>(report.verdict)] = 1;
    tally.add(report, world.map, world.map);
  }
  report.verdict = LoopVerdict::closed;
  report.attempts = {};
  report.attempts[static_cast<std::size_t>(LoopVerdict::closed)] = 1;
  tally.add(report, world.map, world.map);
  EXPECT_EQ(tally.verdicts[static_cast<std::size_t>(LoopVerdict::tilted)], 15);
  EXPECT_EQ(tally.verdicts[static_cast<std::size_t>(LoopVerdict::unsupported)], 15);
  EXPECT_EQ(tally.verdicts[static_cast<std::size_t>(LoopVerdict::closed)], 1);
  ASSERT_EQ(tally.nearest.size(), LoopTally::most_nearest);
  for (std::size_t i = 0; i < tally.nearest.size(); ++i) {
    EXPECT_EQ(tally.nearest[i].verdict, LoopVerdict::tilted) << i;
    EXPECT_EQ(tally.nearest[i].inliers, 29 - 2 * static_cast<int>(i)) << i;
  }
}

}  // namespace
}  // namespace vsgraphs
