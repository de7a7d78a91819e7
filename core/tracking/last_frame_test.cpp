#include "core/tracking/last_frame.h"

#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

class LastFrameTest : public ::testing::Test {
 protected:
  // Sees two points from 0.5 m beside its keyframe.
  FrameState frame(KeyframeId anchor) const {
    FrameState state;
    state.index = 7;
    state.features = keyframe_seeing(camera_, {}, points_).features;
    state.landmarks.resize(points_.size());
    state.pose = {anchor, standing_at(0.5)};
    return state;
  }
  KeyframeId keyframe(Map& map, std::int64_t frame_index, const Se3& world_from_camera = {}) const {
    Keyframe kept = keyframe_seeing(camera_, world_from_camera, points_);
    kept.frame_index = frame_index;
    return add_keyframe(map, kept);
  }
  static KnownMap known(Map& map) { return {map.snapshot(), nullptr}; }
  double x() const { return last_.world_from_camera().translation().x(); }

  Camera camera_;
  Points points_{{0, 0, 2}, {0.2, 0, 2}};
  Map map_;
  LastFrame last_;
};

TEST_F(LastFrameTest, NoFrameIsInNoMap) {
  EXPECT_FALSE(last_.exists());
  EXPECT_EQ(last_.find_in({known(map_), {}}), nullptr);
  EXPECT_FALSE(last_.name_own_keyframe(map_).valid());
}

TEST_F(LastFrameTest, StandsWhereItsKeyframeHasBeenMovedTo) {
  const KeyframeId id = keyframe(map_, 3);
  last_.set(frame(id));
  KnownMaps maps{known(map_), {}};
  EXPECT_EQ(last_.find_in(maps), &maps.active);
  EXPECT_NEAR(x(), 0.5, 1e-12);
  map_.apply(MoveKeyframe{id, standing_at(2)});
  maps.active = known(map_);
  EXPECT_EQ(last_.find_in(maps), &maps.active);
  EXPECT_NEAR(x(), 2.5, 1e-12);
}

TEST_F(LastFrameTest, HangsOnWhatItsCulledKeyframeHangsOn) {
  const KeyframeId gone = keyframe(map_, 3, standing_at(1)), stays = keyframe(map_, 4, standing_at(3));
  last_.set(frame(gone));
  map_.apply(RemoveKeyframe{gone, stays});
  const KnownMaps maps{known(map_), {}};
  ASSERT_NE(last_.find_in(maps), nullptr);
  EXPECT_EQ(last_.state().pose.keyframe, stays);
  EXPECT_NEAR(x(), 1.5, 1e-12);
}

TEST_F(LastFrameTest, IsFoundInADormantMapOrInNone) {
  Map other;
  last_.set(frame(keyframe(map_, 3)));
  const KnownMaps maps{known(other), {known(map_)}};
  EXPECT_EQ(last_.find_in(maps), &maps.dormant.front());
  EXPECT_EQ(last_.find_in({known(other), {}}), nullptr);
}

// A frame that starts a map is there before its keyframe is.
TEST_F(LastFrameTest, AFrameThatStartedAMapLearnsTheNameOfItsKeyframe) {
  last_.set(frame({}));
  EXPECT_FALSE(last_.name_own_keyframe(map_).valid()) << "not made yet";
  const KeyframeId own = keyframe(map_, 7);
  EXPECT_EQ(last_.name_own_keyframe(map_), own);
  EXPECT_EQ(last_.state().pose.keyframe, own);
  EXPECT_FALSE(last_.name_own_keyframe(map_).valid()) << "it has a name";
}

TEST_F(LastFrameTest, TakesTheLandmarksThatItsOwnKeyframeWasGiven) {
  const KeyframeId anchor = keyframe(map_, 3), own = keyframe(map_, 7);
  const LandmarkId mapped = add_landmark(map_, points_[1], 1, {{own, 1}});
  last_.set(frame(anchor));
  last_.find_in({known(map_), {}});
  EXPECT_EQ(last_.state().landmarks, (std::vector<LandmarkId>{{}, mapped}));
}

TEST_F(LastFrameTest, OtherwiseItsLandmarksAreThoseTheyWereMergedInto) {
  const KeyframeId anchor = keyframe(map_, 3);
  const LandmarkId a = add_landmark(map_, points_[0], 0, {{anchor, 0}});
  const LandmarkId b = add_landmark(map_, points_[1], 1, {{anchor, 1}});
  FrameState state = frame(anchor);
  state.landmarks = {b, {}};
  last_.set(state);
  map_.apply(MergeLandmark{b, a});
  last_.find_in({known(map_), {}});
  EXPECT_EQ(last_.state().landmarks, (std::vector<LandmarkId>{a, {}}));
}

}  // namespace
}  // namespace vsgraphs
