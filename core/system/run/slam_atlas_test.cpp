// Whole runs in which the camera is carried off unseen, comes back, or starts in yesterday's map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "core/base/check.h"
#include "core/system/maps/test_followers.h"
#include "core/system/run/slam.h"
#include "core/system/run/test_wall_scene.h"

namespace vsgraphs {
namespace {

using namespace test;

class Walk {
 public:
  explicit Walk(const Config& config, const AtlasState& known = {})
      : config_(config), slam_(config, small_camera(), known) {}

  TrackStatus see(int px) {
    const TrackedFrame seen = slam_.track(scene_.seen_from(px));
    if (!class_names_.empty() && seen.keyframe_request) {
      const Image<std::uint8_t> roles(width, height, 0);
      const Image<std::uint16_t> classes(width, height, 1);
      slam_.add_segmentation(seen.index, {roles.view(), {}, {}, classes.view(), class_names_});
    }
    return seen.status;
  }
  // What a segmenter calls all that keyframes see from here on.
  void call_all(const std::string& name) { class_names_ = {name}; }
  // Dark for 1.6 s: time enough to be carried anywhere.
  void cover() {
    for (int i = 0; i < 16; ++i) slam_.track(scene_.in_the_dark());
  }
  // In steps of 8 px, 0.06 m.
  void walk(int from_px, int to_px) {
    const int step = from_px < to_px ? 8 : -8;
    for (int px = from_px; px != to_px; px += step) see(px);
  }
  // Whatever happened to the maps, all that follows them fits them, and they could be saved.
  void finish() {
    slam_.finish();
    expect_followers_fit();
  }
  void expect_followers_fit() const {
    for (const MapState& state : slam_.atlas_state().maps) {
      EXPECT_STREQ(wrong_with_references(*state.map), nullptr);
      EXPECT_STREQ(wrong_with_values(*state.map), nullptr);
      for (const auto& follower : state.followers.all())
        EXPECT_STREQ(follower->wrong_with(*state.map), nullptr) << follower->name();
      expect_followers_like_gathered(state, config_, small_camera());
    }
  }
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
  Config config_;
  WallScene scene_;
  std::vector<std::string> class_names_;
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

TEST(Atlas, AJoinedMapKnowsTheClassesOfBothAndItsWallsTheVotesOfBoth) {
  Walk walk(configured("serial"));
  walk.call_all("wall");
  walk.walk(0, 160);
  walk.cover();
  walk.call_all("picture");
  walk.walk(520, 120);
  walk.finish();
  ASSERT_EQ(walk.slam().statistics().merges, 1);
  const Snapshot map = walk.slam().snapshot();
  const ClassId wall = class_id("wall"), picture = class_id("picture");
  EXPECT_EQ(map->class_names(), (ClassNames{{wall, "wall"}, {picture, "picture"}}));
  float as_wall = 0, as_picture = 0;
  map->planes().for_each([&](PlaneId, const MappedPlane& plane) {
    for (const ClassVote& vote : plane.class_votes) (vote.id == wall ? as_wall : as_picture) += vote.weight;
  });
  EXPECT_GT(as_wall, 1);
  EXPECT_GT(as_picture, 1);
}

TEST(Atlas, ARunIsToldOfAClassWhoseNumberAnotherHasInTheMapsItBeganWith) {
  Walk yesterday(configured("serial"));
  yesterday.call_all("liquid");
  yesterday.walk(0, 160);
  yesterday.finish();
  Walk today(configured("serial"), yesterday.slam().atlas_state());
  today.call_all("costarring");
  try {
    today.walk(40, 160);
    FAIL() << "nothing said";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("'liquid'"), testing::HasSubstr("'costarring'")));
  }
}

TEST(Atlas, WithoutAWayBackTheMapMostWasMadeOfIsGivenOut) {
  Walk walk(configured("serial"));
  walk.walk(0, 240);
  walk.cover();
  walk.walk(680, 592);
  ASSERT_EQ(walk.slam().atlas_state().maps.size(), 2U);
  walk.expect_followers_fit();
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
  EXPECT_EQ(after.maps.back().followers.all().size(), 3U);
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

// Between frames 0.1 s apart mapping has time for all that a keyframe brings about, whatever the machine.
TEST(Atlas, AtALowFrameRateAThreadedRunIsTheSerialOne) {
  Walk threaded(configured("threaded")), serial(configured("serial"));
  leave_and_come_back(threaded);
  leave_and_come_back(serial);
  EXPECT_EQ(threaded.slam().statistics().merges, 1);
  expect_same_bytes(threaded.slam().trajectory(), serial.slam().trajectory());
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
        for (const KeyframeId id : state.places()->keyframes())
          if (!state.map->keyframes().contains(id)) consistent = false;
        for (const auto& follower : state.followers.all())
          if (follower->wrong_with(*state.map)) consistent = false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
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

TEST(Atlas, ARunKnowsWhatItStartedFrom) {
  AtlasState known = first_session();
  EXPECT_EQ(known.loaded, AtlasVersion{});
  known.loaded = {12, 34};
  Walk walk(configured("serial"), known);
  walk.see(120);
  EXPECT_EQ(walk.slam().atlas_state().loaded, known.loaded);
  walk.finish();
  EXPECT_EQ(walk.slam().atlas_state().loaded, known.loaded);
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
  Walk walk(configured("serial"), AtlasState{{{empty.snapshot(), {}}}, {}});
  EXPECT_EQ(walk.see(0), TrackStatus::initialised);
}

TEST(Atlas, AnIndexThatIsMissingIsMadeAnew) {
  AtlasState known = first_session();
  known.maps[0].followers = {};
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
  EXPECT_THROW(Slam(config, small_camera(), AtlasState{{{empty.snapshot(), {}}}, {}}), InputError);
}

}  // namespace
}  // namespace vsgraphs
