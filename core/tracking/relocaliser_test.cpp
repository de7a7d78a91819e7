#include "core/tracking/relocaliser.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/loops/test_loop_world.h"
#include "core/vision/place_keeper.h"

namespace vsgraphs {
namespace {

using namespace test;

// A room seen all around; the lost frame shows what keyframe `k` saw.
class RelocaliserTest : public ::testing::Test {
 protected:
  static LoopWorldOptions room() {
    LoopWorldOptions o;
    o.keyframes = 30;
    o.patches = false;
    return o;
  }
  RelocaliserTest() { complete(world_.map, places_); }

  const Keyframe& keyframe(int k) const {
    return *world_.map.keyframes().find(world_.ids[static_cast<std::size_t>(k)]);
  }
  FrameState frame_like(int k) const {
    FrameState state;
    state.index = 1000;
    state.timestamp_s = 100;
    state.features = keyframe(k).features;
    state.surface = keyframe(k).surface;
    state.landmarks.resize(static_cast<std::size_t>(state.features->size()));
    return state;
  }
  // The camera was lost where keyframe `k` stands, so long ago.
  void lose_at(int k, double seconds_ago) {
    FrameState state = frame_like(k);
    state.index = 900;
    state.timestamp_s -= seconds_ago;
    state.landmarks = keyframe(k).landmarks;
    state.pose = {world_.ids[static_cast<std::size_t>(k)], {}};
    last_.set(std::move(state));
  }
  KnownMap room_map() { return {world_.map.snapshot(), std::make_shared<const PlaceIndex>(places_)}; }
  static KnownMap empty_map() {
    Map empty;
    return {empty.snapshot(), std::make_shared<const PlaceIndex>()};
  }
  std::optional<Relocalisation> search(const KnownMaps& known, const FrameState& now) {
    LocalMapMatcher matcher{options_, world_.camera, world_.pyramid};
    Relocaliser relocaliser{options_, recovery_, verifier_, matcher};
    return relocaliser.search(known, last_.find_in(known), last_, now);
  }
  double off_m(const Relocalisation& found, int k) const {
    return (found.found.pose.world_from_camera.translation() - keyframe(k).world_from_camera.translation())
        .norm();
  }

  LoopWorld world_{room()};
  PlaceIndex places_;
  TrackerOptions options_;
  Recovery recovery_{options_.recovery, world_.camera, world_.pyramid, 1};
  DepthAligner aligner_{world_.camera};
  PoseVerifier verifier_{options_.recovery, world_.camera, aligner_};
  LastFrame last_;
};

TEST_F(RelocaliserTest, FindsTheLastFramesSurroundingsWithoutAskingForPlaces) {
  lose_at(5, 1.0);
  const KnownMaps known{{world_.map.snapshot(), std::make_shared<const PlaceIndex>()}, {}};
  const auto found = search(known, frame_like(6));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->in, &known.active);
  EXPECT_LT(off_m(*found, 6), 0.01);
}

TEST_F(RelocaliserTest, FindsAnyPlaceOfTheMapByItsLook) {
  lose_at(5, 10.0);
  const KnownMaps known{room_map(), {}};
  const auto found = search(known, frame_like(20));
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(off_m(*found, 20), 0.01);
}

TEST_F(RelocaliserTest, ButNoneThatTheCameraCannotHaveReached) {
  lose_at(5, 0.1);
  const KnownMaps known{room_map(), {}};
  EXPECT_FALSE(search(known, frame_like(20)).has_value());
}

TEST_F(RelocaliserTest, FindsItselfInADormantMap) {
  const KnownMaps known{empty_map(), {room_map()}};
  const auto found = search(known, frame_like(20));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->in, &known.dormant.front());
  EXPECT_LT(off_m(*found, 20), 0.01);
}

// In a map it was not in before twice as many landmarks must be found, unless it can do nothing but wait.
TEST_F(RelocaliserTest, AMapTheCameraWasNotInMustShowTwiceAsMuch) {
  const KnownMaps known{room_map(), {}};
  const FrameState now = frame_like(20);
  const int inliers = search(known, now)->found.pose.inliers;
  options_.recovery.min_place_inliers = inliers * 3 / 4;
  EXPECT_FALSE(search(known, now).has_value());
  options_.new_map_after_s = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(search(known, now).has_value()) << "it never starts a map";
  options_.new_map_after_s = 2;
  lose_at(5, 10.0);
  EXPECT_TRUE(search(known, now).has_value()) << "it was here";
  options_.recovery.min_place_inliers = inliers + 1;
  EXPECT_FALSE(search(known, now).has_value());
}

TEST_F(RelocaliserTest, APlaceWhoseWallsItLooksThroughIsAnother) {
  const KnownMaps known{room_map(), {}};
  FrameState now = frame_like(20);
  now.surface = std::make_shared<const DepthGrid>(
      grid_of(world_.camera, keyframe(20).world_from_camera, square_room(4)));
  EXPECT_FALSE(search(known, now).has_value());
}

TEST_F(RelocaliserTest, WhatItNeverSawIsNotFound) {
  FrameState now = frame_like(20);
  now.features = keyframe_seeing(world_.camera, {}, point_grid(12, 8), 50000).features;
  now.landmarks.resize(96);
  lose_at(5, 10.0);
  EXPECT_FALSE(search({room_map(), {}}, now).has_value());
}

}  // namespace
}  // namespace vsgraphs
