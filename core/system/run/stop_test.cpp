// A run that is told to stop while work waits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/system/run/slam.h"
#include "core/system/run/test_wall_scene.h"

namespace vsgraphs {
namespace {

using namespace test;

constexpr int frames = 24;

class StoppedRun : public ::testing::TestWithParam<const char*> {};

TEST_P(StoppedRun, PassesFramesOverAndKeepsWhatIsThere) {
  WallScene scene;
  Slam slam(configured(GetParam()), small_camera());
  for (int i = 0; i < frames; ++i) ASSERT_TRUE(has_pose(slam.track(scene.seen_from(8 * i)).status));
  slam.stop();
  for (int i = frames; i < frames + 3; ++i) {
    const TrackedFrame passed_over = slam.track(scene.seen_from(8 * i));
    EXPECT_EQ(passed_over.status, TrackStatus::waiting);
    EXPECT_EQ(passed_over.keyframe_request, nullptr);
  }
  slam.finish();
  EXPECT_EQ(slam.statistics().frames, frames);
  const std::vector<TimedPose> trajectory = slam.trajectory();
  ASSERT_EQ(trajectory.size(), static_cast<std::size_t>(frames));
  for (const TimedPose& pose : trajectory)
    EXPECT_LT((pose.world_from_camera.translation() - *scene.truth(pose.timestamp_s)).norm(), 0.03);
  EXPECT_GE(slam.atlas_state().maps.size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Executions, StoppedRun, ::testing::Values("serial", "threaded"));

TEST(StoppedReplay, IsNoDeparture) {
  const std::string schedule = testing::TempDir() + "stop_test_schedule.txt";
  const auto run = [](const Config& config, int stop_after) {
    WallScene scene;
    Slam slam(config, small_camera());
    for (int i = 0; i < frames; ++i) {
      if (i == stop_after) slam.stop();
      slam.track(scene.seen_from(8 * i));
    }
    slam.finish();
    return slam.trajectory();
  };
  Config recording = configured("threaded"), replaying = configured("serial");
  recording.set("system.schedule_out", schedule);
  replaying.set("system.replay", schedule);
  run(recording, frames);
  EXPECT_EQ(run(replaying, 15).size(), 15U);
  // And the schedule of a run that was stopped can be replayed.
  const std::vector<TimedPose> stopped = run(recording, 15), again = run(replaying, frames);
  ASSERT_EQ(again.size(), stopped.size());
  for (std::size_t i = 0; i < again.size(); ++i)
    EXPECT_TRUE(again[i].world_from_camera.matrix() == stopped[i].world_from_camera.matrix()) << i;
}

// A queue that is never empty, since each thing in it takes longer to work on than to put there.
TEST(StoppedThreads, LeaveOutWhatWaits) {
  WallScene scene;
  Slam slam(configured("threaded"), small_camera());
  std::int64_t keyframe = -1;
  for (int i = 0; i < 6; ++i) {
    const TrackedFrame frame = slam.track(scene.seen_from(8 * i));
    if (frame.keyframe_request) keyframe = frame.index;
  }
  ASSERT_GE(keyframe, 0);
  const std::uint64_t before = slam.snapshot()->version();
  const Image<std::uint8_t> roles(width, height, 0);
  std::atomic<bool> enough = false;
  std::atomic<std::uint64_t> given = 0;
  std::thread segmenter([&] {
    while (!enough) {
      slam.add_segmentation(keyframe, {roles.view(), {}, {}});
      ++given;
    }
  });
  while (given < 80) std::this_thread::yield();  // more than the queue holds
  slam.stop();
  enough = true;
  segmenter.join();
  slam.finish();
  EXPECT_LT(slam.snapshot()->version(), before + given);
}

}  // namespace
}  // namespace vsgraphs
