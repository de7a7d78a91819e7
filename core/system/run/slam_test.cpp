// Whole runs on a scene whose truth needs no renderer: the camera slides sideways along a painted wall, so that each
// image is the last one shifted by whole pixels. Short, for the sanitizers run it too.
#include "core/system/run/slam.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "core/base/check.h"
#include "core/base/rng.h"
#include "core/vision/test_painted_wall.h"

namespace vsgraphs {
namespace {

constexpr int width = test::painted_view_width, height = test::painted_view_height, frame_count = 40,
              shift_px = 3;
constexpr double wall_m = 2.0, fps = 30.0;

Camera small_camera() { return test::painted_wall_camera(fps); }

// A strip of wall as long as the way.
Image<std::uint8_t> painted_wall() {
  return test::painted_wall(width + frame_count * shift_px, 1500, Rng(7, "painted_wall", 0));
}

class ShortRun {
 public:
  explicit ShortRun(const Config& config) : slam_(config, small_camera()) {}

  enum class Sees { all, depth_only, nothing };

  TrackedFrame track(int index, Sees sees = Sees::all) {
    RgbdFrame frame;
    frame.timestamp_s = index / fps;
    const ImageView<std::uint8_t> wall = wall_.view();
    frame.grey = sees == Sees::all
                     ? ImageView<std::uint8_t>{wall.data + index * shift_px, width, height, wall.stride}
                     : dark_.view();
    frame.depth.metres = sees == Sees::nothing ? no_depth_.view() : depth_.view();
    return slam_.track(frame);
  }
  void track_all() {
    for (int i = 0; i < frame_count; ++i) EXPECT_TRUE(has_pose(track(i).status)) << "frame " << i;
    slam_.finish();
  }
  Slam& slam() { return slam_; }

 private:
  Image<std::uint8_t> wall_ = painted_wall();
  Image<std::uint8_t> dark_{width, height, 0};
  Image<float> depth_{width, height, static_cast<float>(wall_m)};
  Image<float> no_depth_{width, height, 0.0F};
  Slam slam_;
};

Config configured(const std::string& execution) {
  Config config;
  config.set("system.execution", execution);
  return config;
}

// Largest distance from where the camera was, m. The world is the first camera, so nothing needs to be aligned.
double largest_error_m(const std::vector<TimedPose>& trajectory) {
  double largest = 0;
  for (const TimedPose& pose : trajectory) {
    const double travelled_m = pose.timestamp_s * fps * shift_px * wall_m / small_camera().fx;
    largest =
        std::max(largest, (pose.world_from_camera.translation() - Eigen::Vector3d(travelled_m, 0, 0)).norm());
  }
  return largest;
}

void expect_same_bytes(const std::vector<TimedPose>& a, const std::vector<TimedPose>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].timestamp_s, b[i].timestamp_s);
    EXPECT_TRUE(a[i].world_from_camera.matrix() == b[i].world_from_camera.matrix()) << "frame " << i;
  }
}

TEST(Slam, SerialRunFollowsTheCamera) {
  ShortRun run(configured("serial"));
  run.track_all();
  EXPECT_EQ(run.slam().trajectory().size(), static_cast<std::size_t>(frame_count));
  EXPECT_LT(largest_error_m(run.slam().trajectory()), 0.01);
  EXPECT_GE(run.slam().snapshot()->keyframes().size(), 2U);
}

// Others read snapshots as fast as they can while tracking and mapping go on; the thread sanitizer watches.
TEST(Slam, ThreadedRunFollowsTheCameraWhileOthersReadTheMap) {
  ShortRun run(configured("threaded"));
  std::atomic<bool> stop = false;
  std::atomic<bool> consistent = true;
  std::thread reader([&] {
    while (!stop) {
      const Snapshot map = run.slam().snapshot();
      map->landmarks().for_each([&](LandmarkId, const Landmark& landmark) {
        for (const Observation& seen : landmark.observations)
          if (map->keyframes().find(seen.keyframe) == nullptr) consistent = false;
      });
    }
  });
  run.track_all();
  stop = true;
  reader.join();
  EXPECT_TRUE(consistent);
  EXPECT_LT(largest_error_m(run.slam().trajectory()), 0.01);
}

// Four readers ask for all there is to ask for, without a pause: no frame may be refused or lost for it.
TEST(Slam, ReadersNeverKeepAFrameFromBeingTracked) {
  ShortRun run(configured("threaded"));
  std::atomic<bool> stop = false;
  std::atomic<std::int64_t> reads = 0;
  std::vector<std::thread> readers;
  for (int i = 0; i < 4; ++i)
    readers.emplace_back([&] {
      while (!stop) {
        const std::size_t poses = run.slam().trajectory().size();
        const RunStatistics statistics = run.slam().statistics();
        if (poses <= static_cast<std::size_t>(statistics.tracked) && run.slam().backlog() >= 0 &&
            run.slam().spans().empty())
          ++reads;
      }
    });
  for (int i = 0; i < frame_count; ++i) EXPECT_TRUE(has_pose(run.track(i).status)) << "frame " << i;
  stop = true;
  for (std::thread& reader : readers) reader.join();
  run.slam().finish();
  EXPECT_GT(reads, 10);
  EXPECT_EQ(run.slam().trajectory().size(), static_cast<std::size_t>(frame_count));
  EXPECT_EQ(run.slam().statistics().frames, frame_count);
}

TEST(Slam, SerialRunsAreTheSameBytes) {
  ShortRun first(configured("serial")), second(configured("serial"));
  first.track_all();
  second.track_all();
  expect_same_bytes(first.slam().trajectory(), second.slam().trajectory());
}

TEST(Slam, ReplayRepeatsAThreadedRun) {
  const std::string schedule = testing::TempDir() + "slam_test_schedule.txt";
  Config recording = configured("threaded");
  recording.set("system.schedule_out", schedule);
  ShortRun recorded(recording);
  recorded.track_all();
  Config replaying = configured("serial");
  replaying.set("system.replay", schedule);
  ShortRun replayed(replaying);
  replayed.track_all();
  expect_same_bytes(recorded.slam().trajectory(), replayed.slam().trajectory());
}

// A marker on the wall, in front of where the run begins, is seen in every keyframe.
void track_with_marker(ShortRun& run) {
  for (int i = 0; i < frame_count; ++i) {
    const TrackedFrame frame = run.track(i);
    const Se3 seen = frame.world_from_camera.inverse() * Se3(Eigen::Matrix3d::Identity(), {0, 0, wall_m});
    if (frame.keyframe_request)
      run.slam().add_markers(frame.index, {{{7}, 0.16, seen, 1e-4 * Matrix6d::Identity()}});
  }
  run.slam().finish();
}

TEST(Slam, MarkersOfKeyframesAreMapped) {
  for (const char* execution : {"serial", "threaded"}) {
    ShortRun run(configured(execution));
    track_with_marker(run);
    const Snapshot map = run.slam().snapshot();
    ASSERT_EQ(map->markers().size(), 1U);
    const MappedMarker& marker = *map->markers().at({7});
    EXPECT_GE(marker.observations.size(), 2U);
    EXPECT_LT((marker.world_from_marker.translation() - Eigen::Vector3d(0, 0, wall_m)).norm(), 0.02);
    EXPECT_LT(largest_error_m(run.slam().trajectory()), 0.01);
  }
}

TEST(Slam, MarkersOfOtherFramesAndAfterTheEndHaveNoEffect) {
  ShortRun run(configured("serial"));
  const MarkerDetection seen{
      {7}, 0.16, Se3(Eigen::Matrix3d::Identity(), {0, 0, 2}), 1e-4 * Matrix6d::Identity()};
  run.slam().add_markers(0, {seen});
  int ordinary = -1;  // a frame that is no keyframe
  for (int i = 0; i < 6; ++i) {
    if (!run.track(i).keyframe_request) ordinary = i;
  }
  ASSERT_GE(ordinary, 0);
  EXPECT_TRUE(run.slam().snapshot()->markers().empty()) << "before there was a frame";
  run.slam().add_markers(ordinary, {seen});
  EXPECT_TRUE(run.slam().snapshot()->markers().empty()) << "no keyframe";
  run.slam().add_markers(99, {seen});
  EXPECT_TRUE(run.slam().snapshot()->markers().empty()) << "no frame";
  run.slam().finish();
  run.slam().add_markers(0, {seen});
  EXPECT_TRUE(run.slam().snapshot()->markers().empty());
  EXPECT_THROW(run.slam().add_markers(0, {MarkerDetection{}}), InputError) << "no size";
}

TEST(Slam, ReplayRepeatsAThreadedRunWithMarkersAndMissesThem) {
  const std::string schedule = testing::TempDir() + "slam_test_markers.txt";
  Config recording = configured("threaded");
  recording.set("system.schedule_out", schedule);
  ShortRun recorded(recording);
  track_with_marker(recorded);
  Config replaying = configured("serial");
  replaying.set("system.replay", schedule);
  ShortRun replayed(replaying);
  // What was seen then, frame by frame: the poses of the replay are the same.
  track_with_marker(replayed);
  expect_same_bytes(recorded.slam().trajectory(), replayed.slam().trajectory());
  ShortRun without(replaying);
  EXPECT_THROW(without.track_all(), RunError);
}

TEST(Slam, ACoveredLensIsSurvivedAndSaid) {
  ShortRun run(configured("threaded"));
  for (int i = 0; i < 15; ++i) run.track(i);
  // For longer than coasting is allowed.
  for (int i = 15; i < 35; ++i) EXPECT_NE(run.track(i, ShortRun::Sees::nothing).status, TrackStatus::ok);
  EXPECT_TRUE(has_pose(run.track(35).status));
  run.slam().finish();
  const std::vector<std::string> warnings = run.slam().statistics().warnings;
  EXPECT_THAT(warnings, testing::ElementsAre(testing::HasSubstr("lost"), testing::HasSubstr("relocalised")));
  EXPECT_LT(largest_error_m({run.slam().trajectory().back()}), 0.02);
}

// The lights go out, depth goes on: the wall holds the distance and the turn, but not the way along it.
TEST(Slam, InTheDarkAWallHoldsThePoseOnlyInPart) {
  ShortRun run(configured("serial"));
  for (int i = 0; i < 15; ++i) run.track(i);
  for (int i = 15; i < 30; ++i) {
    const TrackedFrame frame = run.track(i, ShortRun::Sees::depth_only);
    EXPECT_EQ(frame.status, TrackStatus::coasting) << "frame " << i;
    EXPECT_NEAR(frame.world_from_camera.translation().z(), 0, 0.01) << "frame " << i;
  }
  EXPECT_TRUE(has_pose(run.track(30).status));  // the first with light has only dark ones to be compared with
  for (int i = 31; i < frame_count; ++i) EXPECT_EQ(run.track(i).status, TrackStatus::ok) << "frame " << i;
  run.slam().finish();
  EXPECT_LT(largest_error_m({run.slam().trajectory().back()}), 0.02);
}

TEST(Slam, BadTimestampsChangeNothing) {
  ShortRun run(configured("serial"));
  run.track(0);
  run.track(1);
  EXPECT_THROW(run.track(1), InputError);
  EXPECT_THROW(run.track(0), InputError);
  EXPECT_TRUE(has_pose(run.track(2).status));
  EXPECT_EQ(run.slam().statistics().frames, 3);
}

// What a forked child makes of its parent's Slam: 0 if everything is refused and its end comes at once.
int use_and_destroy(std::unique_ptr<ShortRun> run) {
  ::alarm(20);  // what hangs is ended
  int accepted = 0;
  const auto refused = [&accepted](auto call) {
    try {
      call();
      ++accepted;
    } catch (const RunError&) {
    }
  };
  Slam& slam = run->slam();
  refused([&] { run->track(3); });
  refused([&] { slam.snapshot(); });
  refused([&] { slam.atlas_state(); });
  refused([&] { slam.trajectory(); });
  refused([&] { slam.statistics(); });
  refused([&] { slam.backlog(); });
  refused([&] { slam.spans(); });
  refused([&] { slam.add_markers(0, {}); });
  refused([&] { slam.stop(); });
  refused([&] { slam.finish(); });
  run.reset();
  return accepted;
}

TEST(Slam, AForkedChildIsToldAndEnds) {
  for (const char* execution : {"threaded", "serial"}) {
    auto run = std::make_unique<ShortRun>(configured(execution));
    for (int i = 0; i < 3; ++i) run->track(i);
    const pid_t child = ::fork();
    if (child == 0) ::_exit(use_and_destroy(std::move(run)));
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status)) << execution << ": ended by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0) << execution;
    EXPECT_TRUE(has_pose(run->track(3).status)) << "the parent goes on";
  }
}

}  // namespace
}  // namespace vsgraphs
