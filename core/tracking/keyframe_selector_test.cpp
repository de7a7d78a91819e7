#include "core/tracking/keyframe_selector.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

// The last request is of a frame at the origin, which became keyframe `first_`; all 24 points are landmarks.
class KeyframeSelectorTest : public ::testing::Test {
 protected:
  KeyframeSelectorTest() {
    FrameState start = frame({}, 24, 10);
    start.pose = {};
    selector_.request(start, true, {});
    selector_.name_first(first_);
  }
  static KeyframePolicyOptions options() {
    KeyframePolicyOptions o;
    o.few_close_points = 0;
    return o;
  }
  // Shows all points, of which it tracked as many.
  FrameState frame(const Se3& world_from_camera, std::size_t tracked, double timestamp_s) const {
    FrameState now;
    now.index = 5;
    now.timestamp_s = timestamp_s;
    now.features = keyframe_seeing(camera_, world_from_camera, points_).features;
    now.landmarks.assign(points_.size(), {});
    std::copy_n(landmarks_.begin(), tracked, now.landmarks.begin());
    now.pose = {first_, world_from_camera};
    return now;
  }
  bool wanted(const Se3& at, std::size_t tracked, double timestamp_s = 10.1, int backlog = 0) const {
    return selector_.wanted(map_, frame(at, tracked, timestamp_s), at, backlog);
  }

  Camera camera_;
  Points points_ = point_grid(6, 4);
  Map map_;
  KeyframeId first_ = add_keyframe(map_, keyframe_seeing(camera_, {}, points_));
  std::vector<LandmarkId> landmarks_ = add_landmarks(map_, points_, {first_});
  KeyframeSelector selector_{options()};
};

TEST_F(KeyframeSelectorTest, WhereTheMapThinsOutAMovedCameraIsWanted) {
  EXPECT_TRUE(wanted(standing_at(0.1), 12));
  EXPECT_FALSE(wanted(standing_at(0.1), 23)) << "most of the keyframe's landmarks are tracked";
  EXPECT_FALSE(wanted({}, 12)) << "it has not moved since the last request";
}

TEST_F(KeyframeSelectorTest, TimeBacklogAndSurfacesAreLaidBeforeThePolicy) {
  EXPECT_TRUE(wanted(standing_at(0.1), 23, 11.1)) << "a second has passed";
  EXPECT_FALSE(wanted(standing_at(0.1), 12, 10.1, 3));
  FrameState held = frame(standing_at(0.1), 0, 10.1);
  held.surface_reference = first_;
  EXPECT_FALSE(selector_.wanted(map_, held, standing_at(0.1), 0)) << "surfaces need not be so dense";
}

TEST_F(KeyframeSelectorTest, AKeyframeIsAskedForFromTheOneRequestedLast) {
  FrameState there = frame(standing_at(0.1), 12, 10.1);
  selector_.request(there, false, {});
  EXPECT_FALSE(wanted(standing_at(0.1), 12));
  EXPECT_TRUE(wanted({}, 12));
}

TEST_F(KeyframeSelectorTest, OneInAnotherMapIsInfinitelyFar) {
  KeyframeSelector elsewhere{options()};
  FrameState start = frame({}, 24, 10);
  start.pose.keyframe = {77, 0};
  elsewhere.request(start, true, {});
  EXPECT_TRUE(elsewhere.wanted(map_, frame({}, 12, 10.1), {}, 0));
}

TEST_F(KeyframeSelectorTest, OnlyARequestThatStartedAMapIsNamedAfterwards) {
  selector_.request(frame(standing_at(0.1), 12, 10.1), false, {});
  selector_.name_first({77, 0});
  EXPECT_FALSE(wanted(standing_at(0.1), 12)) << "77 would be in another map";
}

// Of more than two keyframes, landmarks that three of them see are established.
TEST_F(KeyframeSelectorTest, EstablishedLandmarksAloneCount) {
  EXPECT_TRUE(wanted(standing_at(0.1), 12));
  for (const double x : {1.0, 2.0}) {
    const KeyframeId id = add_keyframe(map_, keyframe_seeing(camera_, standing_at(x), points_));
    for (std::uint16_t i = 0; i < 12; ++i) map_.apply(AddObservation{landmarks_[i], {id, i}});
  }
  EXPECT_FALSE(wanted(standing_at(0.1), 12)) << "12 of 12 tracked";
}

TEST_F(KeyframeSelectorTest, ARequestCarriesAllThatTheMapperLearns) {
  FrameState now = frame(standing_at(0.1), 12, 10.1);
  now.surface = std::make_shared<const DepthGrid>();
  now.tracked_link = TrackedLink{first_, standing_at(0.1), Matrix6d::Identity()};
  const auto request = selector_.request(now, false, {{landmarks_[3], 2, 1}});
  EXPECT_EQ(request->frame_index, 5);
  EXPECT_EQ(request->timestamp_s, 10.1);
  EXPECT_FALSE(request->first);
  EXPECT_EQ(request->pose.keyframe, first_);
  EXPECT_EQ(request->features, now.features);
  EXPECT_EQ(request->surface, now.surface);
  EXPECT_EQ(request->tracked_link->to, first_);
  EXPECT_EQ(request->landmarks, now.landmarks);
  ASSERT_EQ(request->sightings.size(), 1U);
  EXPECT_EQ(request->sightings[0].landmark, landmarks_[3]);
}

}  // namespace
}  // namespace vsgraphs
