// Whole runs in which the camera is carried off unseen, comes back, or starts in yesterday's map. The scene is a long painted
// wall; the camera stands 2 m before it and is put along it by whole pixels, so that its truth is known exactly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>

#include "core/base/check.h"
#include "core/base/rng.h"
#include "core/system/map_owner.h"
#include "core/system/slam.h"
#include "core/system/tracking_lane.h"
#include "core/vision/test_painted_wall.h"

namespace vsgraphs {
namespace {

constexpr int width = test::painted_view_width, height = test::painted_view_height, wall_px = 1000;
constexpr double wall_m = 2.0, focal_px = test::painted_view_focal_px, metres_per_px = wall_m / focal_px,
                 frame_s = 0.1;

Camera small_camera() { return test::painted_wall_camera(1 / frame_s); }

Image<std::uint8_t> painted_wall(int seed) {
  return test::painted_wall(wall_px, 2300, Rng(seed, "long_wall", 0));
}

Config configured(const std::string& execution) {
  Config config;
  config.set("system.execution", execution);
  config.set("tracker.new_map_after_s", 0.3);
  config.set("system.min_map_keyframes", std::int64_t{2});
  return config;
}

// What the camera sees of the wall, frame after frame, and where it truly was.
class Scene {
 public:
  static constexpr int nowhere = -1;

  // From `px` pixels along the wall.
  RgbdFrame seen_from(int px) { return before(wall_, px, px); }
  // From somewhere along another wall, nowhere near.
  RgbdFrame seen_elsewhere(int px) { return before(other_wall_, px, nowhere); }
  RgbdFrame in_the_dark() { return frame(dark_.view(), no_depth_.view(), nowhere); }
  // Empty in the dark.
  std::optional<Eigen::Vector3d> truth(double timestamp_s) const {
    const int px = seen_px_[static_cast<std::size_t>(std::lround(timestamp_s / frame_s))];
    if (px == nowhere) return std::nullopt;
    return Eigen::Vector3d(px * metres_per_px, 0, 0);
  }

 private:
  RgbdFrame before(const Image<std::uint8_t>& wall, int px, int truth_px) {
    const ImageView<std::uint8_t> all = wall.view();
    return frame({all.data + px, width, height, all.stride}, depth_.view(), truth_px);
  }
  RgbdFrame frame(const ImageView<std::uint8_t>& grey, const ImageView<float>& depth, int px) {
    RgbdFrame frame;
    frame.index = std::ssize(seen_px_);
    frame.timestamp_s = frame_s * static_cast<double>(seen_px_.size());
    frame.grey = grey;
    frame.depth.metres = depth;
    seen_px_.push_back(px);
    return frame;
  }

  Image<std::uint8_t> wall_ = painted_wall(11), other_wall_ = painted_wall(12), dark_{width, height, 0};
  Image<float> depth_{width, height, static_cast<float>(wall_m)}, no_depth_{width, height, 0.0F};
  std::vector<int> seen_px_;
};

class Walk {
 public:
  explicit Walk(const Config& config, const AtlasState& known = {}) : slam_(config, small_camera(), known) {}

  TrackStatus see(int px) { return slam_.track(scene_.seen_from(px)).status; }
  // Dark for 1.6 s: time enough to be carried anywhere.
  void cover() {
    for (int i = 0; i < 16; ++i) slam_.track(scene_.in_the_dark());
  }
  // In steps of 8 px, 0.06 m.
  void walk(int from_px, int to_px) {
    const int step = from_px < to_px ? 8 : -8;
    for (int px = from_px; px != to_px; px += step) see(px);
  }
  void finish() { slam_.finish(); }
  Slam& slam() { return slam_; }

  // Largest distance from the truth over the trajectory, frames in the dark aside.
  double largest_error_m() const {
    double largest = 0;
    for (const TimedPose& pose : slam_.trajectory()) {
      if (const auto truth = scene_.truth(pose.timestamp_s))
        largest = std::max(largest, (pose.world_from_camera.translation() - *truth).norm());
    }
    return largest;
  }

 private:
  Scene scene_;
  Slam slam_;
};

// Seen at first, carried off in the dark to where nothing is known, and walked back.
void leave_and_come_back(Walk& walk) {
  walk.walk(0, 160);
  walk.cover();
  walk.walk(520, 120);
  walk.finish();
}

void expect_same_bytes(const std::vector<TimedPose>& a, const std::vector<TimedPose>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].timestamp_s, b[i].timestamp_s);
    EXPECT_TRUE(a[i].world_from_camera.matrix() == b[i].world_from_camera.matrix()) << "frame " << i;
  }
}

TEST(Atlas, AfterABlackoutTheCameraIsFoundWhereItWasCarriedTo) {
  Walk walk(configured("serial"));
  walk.walk(0, 400);
  for (const int px : {8, 333, 150}) {
    walk.cover();
    EXPECT_EQ(walk.see(px), TrackStatus::relocalised) << px;
  }
  walk.finish();
  EXPECT_LT(walk.largest_error_m(), 0.03);
  EXPECT_EQ(walk.slam().statistics().maps, 1);
}

TEST(Atlas, WhereNothingIsKnownANewMapStartsAndIsJoinedOnComingBack) {
  Walk walk(configured("serial"));
  leave_and_come_back(walk);
  const RunStatistics s = walk.slam().statistics();
  EXPECT_EQ(s.maps, 1);
  EXPECT_EQ(s.merges, 1);
  EXPECT_EQ(s.elsewhere, 0);
  EXPECT_EQ(walk.slam().trajectory().size(), static_cast<std::size_t>(s.tracked));
  EXPECT_LT(walk.largest_error_m(), 0.03) << "all of it in the first map's world";
  EXPECT_THAT(s.warnings, testing::ElementsAre(testing::HasSubstr("lost"), testing::HasSubstr("new map")));
}

TEST(Atlas, WithoutAWayBackTheMapMostWasMadeOfIsGivenOut) {
  Walk walk(configured("serial"));
  walk.walk(0, 240);
  walk.cover();
  walk.walk(680, 592);
  const AtlasState during = walk.slam().atlas_state();
  ASSERT_EQ(during.maps.size(), 2U);
  walk.finish();
  const RunStatistics s = walk.slam().statistics();
  EXPECT_EQ(s.maps, 2);
  EXPECT_EQ(s.merges, 0);
  EXPECT_GT(s.elsewhere, 0);
  EXPECT_EQ(walk.slam().trajectory().size(), static_cast<std::size_t>(s.tracked - s.elsewhere));
  EXPECT_LT(walk.largest_error_m(), 0.03);
  EXPECT_THAT(s.warnings.back(), testing::HasSubstr("never joined"));

  const AtlasState after = walk.slam().atlas_state();
  ASSERT_EQ(after.maps.size(), 2U);
  EXPECT_EQ(after.maps.back().map, walk.slam().snapshot()) << "the map worked on comes last";
  EXPECT_NE(after.maps.back().free_space, nullptr);
  after.maps[0].map->keyframes().for_each(
      [&](KeyframeId id, const Keyframe&) { EXPECT_FALSE(after.maps[1].map->keyframes().contains(id)); });
  after.maps[0].map->landmarks().for_each(
      [&](LandmarkId id, const Landmark&) { EXPECT_FALSE(after.maps[1].map->landmarks().contains(id)); });
}

TEST(Atlas, ALostCameraIsFoundInADormantMapWhichIsTakenUpAgain) {
  Walk walk(configured("serial"));
  walk.walk(0, 160);
  walk.cover();
  walk.walk(680, 520);
  walk.cover();
  EXPECT_EQ(walk.see(80), TrackStatus::relocalised);
  walk.walk(88, 240);
  EXPECT_EQ(walk.slam().statistics().maps, 2);
  walk.finish();
  EXPECT_LT(walk.largest_error_m(), 0.03) << "in the world of the map it came back to";
  EXPECT_GT(walk.slam().trajectory().size(), 35U) << "from before and after";
}

TEST(Atlas, AMapOfAGlanceIsDroppedAndSaid) {
  Config config = configured("serial");
  config.set("system.min_map_keyframes", std::int64_t{5});
  Walk walk(config);
  walk.see(0);
  walk.cover();
  walk.walk(520, 680);
  walk.finish();
  EXPECT_EQ(walk.slam().statistics().maps, 1);
  EXPECT_THAT(walk.slam().statistics().warnings, testing::Contains(testing::HasSubstr("dropped")));
  EXPECT_GE(walk.slam().statistics().elsewhere, 1) << "the glance, and what was coasted after it";
}

TEST(Atlas, SerialRunsWithAJoinAreTheSameBytes) {
  Walk first(configured("serial")), second(configured("serial"));
  leave_and_come_back(first);
  leave_and_come_back(second);
  expect_same_bytes(first.slam().trajectory(), second.slam().trajectory());
}

// The thread sanitizer watches; somebody saves the atlas now and then.
TEST(Atlas, AThreadedRunWithANewMapAndAJoinReplaysExactly) {
  const std::string schedule = testing::TempDir() + "slam_atlas_test_schedule.txt";
  Config recording = configured("threaded");
  recording.set("system.schedule_out", schedule);
  Walk recorded(recording);
  std::atomic<bool> stop = false, consistent = true;
  std::thread saver([&] {
    while (!stop) {
      for (const MapState& state : recorded.slam().atlas_state().maps) {
        state.map->landmarks().for_each([&](LandmarkId, const Landmark& landmark) {
          for (const Observation& seen : landmark.observations)
            if (!state.map->keyframes().contains(seen.keyframe)) consistent = false;
        });
        for (const KeyframeId id : state.places->keyframes())
          if (!state.map->keyframes().contains(id)) consistent = false;
      }
    }
  });
  leave_and_come_back(recorded);
  stop = true;
  saver.join();
  EXPECT_TRUE(consistent);
  EXPECT_EQ(recorded.slam().statistics().merges, 1);
  EXPECT_LT(recorded.largest_error_m(), 0.03);
  Config replaying = configured("serial");
  replaying.set("system.replay", schedule);
  Walk replayed(replaying);
  leave_and_come_back(replayed);
  expect_same_bytes(recorded.slam().trajectory(), replayed.slam().trajectory());
}

// Tracking and the map's owner by hand, so that an adjustment of the whole map can be let come late.
class StepByStep {
 public:
  StepByStep() : config_(configured("serial")) {}

  void see(int px) { track(scene_.seen_from(px)); }
  void walk(int from_px, int to_px) {
    const int step = from_px < to_px ? 8 : -8;
    for (int px = from_px; px != to_px; px += step) see(px);
  }
  void cover() {
    for (int i = 0; i < 16; ++i) track(scene_.in_the_dark());
  }
  void walk_elsewhere() {
    for (int px = 0; px < 160; px += 8) track(scene_.seen_elsewhere(px));
  }
  MapOwner& owner() { return owner_; }
  SnapshotCell::Content content() const { return cell_.take(); }
  double largest_error_m() const {
    double largest = 0;
    const Snapshot map = cell_.take().snapshot;
    map->keyframes().for_each([&](KeyframeId, const Keyframe& k) {
      const auto truth = scene_.truth(k.timestamp_s);
      if (truth) largest = std::max(largest, (k.world_from_camera.translation() - *truth).norm());
    });
    return largest;
  }

 private:
  void track(const RgbdFrame& frame) {
    const TrackedFrame result = tracking_.track(frame, cell_.take());
    if (result.keyframe_request) owner_.work_on(*result.keyframe_request, {});
  }

  Config config_;
  Scene scene_;
  SnapshotCell cell_;
  TrackingLane tracking_{config_, small_camera()};
  MapOwner owner_{config_, small_camera(), cell_};
};

TEST(WholeMapAdjustment, ThatComesLateFitsTheMapThatWentOn) {
  StepByStep walk;
  walk.walk(0, 160);
  walk.cover();
  int px = 520;
  for (; !walk.owner().adjustment(); px -= 8) {
    ASSERT_GT(px, 100) << "the two maps were never joined";
    walk.see(px);
  }
  const std::shared_ptr<FullAdjustment> asked_for = walk.owner().adjustment();
  EXPECT_LT(walk.content().completed, walk.content().inserted) << "who waits goes on waiting";
  walk.walk(px, 0);
  walk.walk(0, 240);
  ASSERT_EQ(walk.owner().adjustment(), asked_for) << "nothing moved the map: it is still wanted";
  EXPECT_GT(walk.content().snapshot->version(), asked_for->base().version());
  while (walk.owner().adjustment()) {
    walk.owner().run_adjustment();
    walk.owner().finish_adjustment();
  }
  EXPECT_EQ(walk.content().completed, walk.content().inserted);
  EXPECT_LT(walk.largest_error_m(), 0.03);
  walk.walk(240, 400);
  EXPECT_LT(walk.largest_error_m(), 0.03);
}

TEST(WholeMapAdjustment, IsGivenUpWhereAnotherMapIsWorkedOn) {
  StepByStep walk;
  walk.walk(0, 160);
  walk.cover();
  for (int px = 520; !walk.owner().adjustment() && px > 100; px -= 8) walk.see(px);
  ASSERT_NE(walk.owner().adjustment(), nullptr);
  walk.cover();
  walk.walk_elsewhere();
  EXPECT_EQ(walk.owner().adjustment(), nullptr);
  EXPECT_EQ(walk.content().completed, walk.content().inserted);
}

AtlasState first_session() {
  Walk walk(configured("serial"));
  walk.walk(0, 320);
  walk.finish();
  return walk.slam().atlas_state();
}

TEST(Atlas, ASecondSessionStartsInTheFirstOnesMap) {
  const AtlasState known = first_session();
  Walk walk(configured("serial"), known);
  EXPECT_EQ(walk.see(120), TrackStatus::relocalised);
  walk.walk(128, 480);
  walk.finish();
  EXPECT_LT(walk.largest_error_m(), 0.03);
  EXPECT_EQ(walk.slam().trajectory().size(), 45U) << "its own frames alone";
  EXPECT_GT(walk.slam().snapshot()->keyframes().size(), known.maps[0].map->keyframes().size());
  EXPECT_EQ(walk.slam().statistics().maps, 1);
}

TEST(Atlas, ASecondSessionThatStartsElsewhereIsJoinedInTheFirstOnesWorld) {
  Walk walk(configured("serial"), first_session());
  EXPECT_EQ(walk.see(680), TrackStatus::lost);
  walk.walk(680, 240);
  walk.finish();
  const RunStatistics s = walk.slam().statistics();
  EXPECT_EQ(s.maps, 1);
  EXPECT_EQ(s.merges, 1);
  EXPECT_LT(walk.largest_error_m(), 0.03);
}

TEST(Atlas, AnEmptyAtlasIsLikeNone) {
  Map empty;
  Walk walk(configured("serial"), AtlasState{{{empty.snapshot(), nullptr, nullptr}}});
  EXPECT_EQ(walk.see(0), TrackStatus::initialised);
}

TEST(Atlas, AnIndexThatIsMissingIsMadeAnew) {
  AtlasState known = first_session();
  known.maps[0].places = nullptr;
  known.maps[0].free_space = nullptr;
  Walk walk(configured("serial"), known);
  EXPECT_EQ(walk.see(200), TrackStatus::relocalised);
}

TEST(LocaliseOnly, LocatesTheCameraAndChangesNothing) {
  const AtlasState known = first_session();
  Config config = configured("threaded");
  config.set("system.localise_only", true);
  Walk walk(config, known);
  walk.walk(240, 80);
  walk.cover();
  for (int i = 0; i < 8; ++i) EXPECT_EQ(walk.see(680), TrackStatus::lost) << "and starts no map";
  EXPECT_EQ(walk.see(160), TrackStatus::relocalised);
  walk.finish();
  EXPECT_LT(walk.largest_error_m(), 0.03);
  const AtlasState after = walk.slam().atlas_state();
  ASSERT_EQ(after.maps.size(), 1U);
  const Map &before_map = *known.maps[0].map, &after_map = *after.maps[0].map;
  EXPECT_EQ(after_map.keyframes().size(), before_map.keyframes().size());
  EXPECT_EQ(after_map.landmarks().size(), before_map.landmarks().size());
  before_map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    EXPECT_TRUE(after_map.keyframes().find(id)->world_from_camera.matrix() ==
                keyframe.world_from_camera.matrix());
  });
  before_map.landmarks().for_each([&](LandmarkId id, const Landmark& landmark) {
    EXPECT_EQ(after_map.landmarks().find(id)->found_count, landmark.found_count);
  });
}

TEST(LocaliseOnly, NeedsAMap) {
  Config config;
  config.set("system.localise_only", true);
  EXPECT_THROW(Slam(config, small_camera()), InputError);
  Map empty;
  EXPECT_THROW(Slam(config, small_camera(), AtlasState{{{empty.snapshot(), nullptr, nullptr}}}), InputError);
}

}  // namespace
}  // namespace vsgraphs
