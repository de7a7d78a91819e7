#include "core/tracking/surface_tracker.h"

#include <gtest/gtest.h>

#include "core/tracking/test_tracking_world.h"

namespace vsgraphs {
namespace {

using namespace test;

// The last frame hangs on `anchor_`, which keeps no surface; `keyframe_` does. The camera is at `truth_`.
class SurfaceTrackerTest : public ::testing::Test {
 protected:
  enum class Room { corner, corridor };
  static std::vector<Wall> walls(Room room) { return room == Room::corner ? corner_room() : corridor(); }

  void enter(Room room, bool keyframe_spoilt = false, bool last_spoilt = false) {
    FrameState blank = world_.frame({}, {}, {});
    blank.surface = nullptr;
    anchor_ = world_.keep(blank, {});
    FrameState kept = world_.frame({}, {}, walls(room));
    if (keyframe_spoilt) TrackingWorld::spoil(kept);
    keyframe_ = world_.keep(kept, {});
    FrameState last = world_.frame({}, {}, walls(room));
    if (last_spoilt) TrackingWorld::spoil(last);
    world_.follow(last, {}, anchor_);
    now_ = world_.frame(truth_, {}, walls(room));
  }
  // Some points at `seen_at`, of which the map believes that they are `off` from there.
  std::optional<MatchedPose> see_points(const Points& points, const Se3& seen_from,
                                        const std::vector<Eigen::Vector3d>& off) {
    now_.features = keyframe_seeing(world_.camera, seen_from, points).features;
    now_.landmarks.resize(points.size());
    MatchedPose found;
    found.matches.reset(now_.features->size());
    for (std::size_t i = 0; i < points.size(); ++i)
      found.matches.add({static_cast<int>(i), LandmarkId{}, points[i] + off[i]});
    found.pose.world_from_camera = predicted_;
    found.pose.inliers = found.matches.size();
    return found;
  }
  std::optional<MatchedPose> align(const std::optional<MatchedPose>& found = {}) {
    return tracker_.align(world_.step(now_, predicted_), found);
  }

  TrackingWorld world_;
  TrackerOptions options_;
  DepthAligner aligner_{world_.camera};
  LocalMapMatcher local_map_{options_, world_.camera, world_.pyramid};
  SurfaceTracker tracker_{options_, world_.camera, world_.pyramid, aligner_, local_map_};
  Se3 truth_{so3_exp({0.01, -0.02, 0.01}), {0.03, -0.02, 0.04}}, predicted_;
  KeyframeId anchor_, keyframe_;
  FrameState now_;
};

TEST_F(SurfaceTrackerTest, WithoutMatchesAKeyframesSurfacesHoldThePose) {
  enter(Room::corner);
  const auto held = align();
  ASSERT_TRUE(held.has_value());
  EXPECT_EQ(held->surface_reference, keyframe_);
  EXPECT_LT(way_m(held->pose.world_from_camera, truth_), 0.005);
  EXPECT_LT(turn_rad(held->pose.world_from_camera, truth_), 0.002);
  EXPECT_FALSE(held->pose.degenerate);
}

TEST_F(SurfaceTrackerTest, WhereNoKeyframesSurfacesHoldTheLastFramesAreAsked) {
  enter(Room::corner, true);
  const auto held = align();
  ASSERT_TRUE(held.has_value());
  EXPECT_EQ(held->surface_reference, anchor_) << "the last frame's, which hangs there";
  EXPECT_LT(way_m(held->pose.world_from_camera, truth_), 0.005);
}

TEST_F(SurfaceTrackerTest, WhereNeitherHoldsThereIsNoPose) {
  enter(Room::corner, true, true);
  EXPECT_FALSE(align().has_value());
}

TEST_F(SurfaceTrackerTest, APoseBeyondReachIsNotHeld) {
  truth_ = standing_at(0, 0, 0.19);
  enter(Room::corner);
  EXPECT_FALSE(align().has_value()) << "0.14 m are what a change of velocity explains";
}

// Along a corridor nothing but matches tells the way.
TEST_F(SurfaceTrackerTest, OneOrTwoMatchesAreDropped) {
  enter(Room::corridor);
  truth_ = standing_at(0.03, -0.02, 0);
  now_ = world_.frame(truth_, {}, walls(Room::corridor));
  const Points points{{0.5, 0.2, 2}, {-0.4, -0.3, 2.5}, {0.2, -0.3, 1.8}};
  const std::vector<Eigen::Vector3d> ahead(3, {0, 0, 0.08});
  const auto three = align(see_points(points, truth_, ahead));
  ASSERT_TRUE(three.has_value());
  EXPECT_EQ(three->pose.inliers, 3);
  EXPECT_GT(three->pose.world_from_camera.translation().z(), 0.05);
  for (const std::size_t count : {1, 2}) {
    const Points few(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count));
    const auto held = align(see_points(few, truth_, ahead));
    ASSERT_TRUE(held.has_value()) << count;
    EXPECT_EQ(held->pose.inliers, 0) << count;
    EXPECT_EQ(held->matches.size(), 0) << count;
    EXPECT_NEAR(held->pose.world_from_camera.translation().z(), 0, 0.01) << count;
    EXPECT_LT(way_m(held->pose.world_from_camera, truth_), 0.01) << count;
    EXPECT_EQ(held->surface_reference, keyframe_) << count;
  }
}

// Four, of which surfaces leave two.
TEST_F(SurfaceTrackerTest, WhatIsLeftOfMatchesThatContradictSurfacesIsDroppedToo) {
  enter(Room::corner);
  const Points points{{0.5, 0.2, 2}, {-0.4, -0.3, 2.3}, {0.2, -0.3, 1.8}, {-0.3, 0.3, 2.1}};
  const auto held = align(see_points(points, truth_, {{0, 0, 0}, {0, 0, 0}, {0.6, 0, 0}, {-0.4, 0.5, 0}}));
  ASSERT_TRUE(held.has_value());
  EXPECT_EQ(held->pose.inliers, 0);
  EXPECT_LT(way_m(held->pose.world_from_camera, truth_), 0.005);
}

TEST_F(SurfaceTrackerTest, WhereSurfacesDoNotHoldTheMatchesAreGivenBack) {
  enter(Room::corner);
  now_.surface = std::make_shared<const DepthGrid>(grid_of(world_.camera, truth_, {}));
  const auto found = see_points({{0.5, 0.2, 2}, {-0.4, -0.3, 2.3}}, truth_, {{0, 0, 0}, {0, 0, 0}});
  const auto stands = align(found);
  ASSERT_TRUE(stands.has_value());
  EXPECT_EQ(stands->matches.size(), 2);
  EXPECT_EQ(stands->matches.all()[1].feature, 1);
  EXPECT_TRUE(stands->pose.world_from_camera.matrix() == found->pose.world_from_camera.matrix());
  EXPECT_FALSE(stands->surface_reference.valid());
}

TEST_F(SurfaceTrackerTest, AFewMatchesThatSurfacesContradictAreACoincidence) {
  enter(Room::corner, true, true);
  const Points points = point_grid(6, 4);
  auto found = see_points(points, predicted_, std::vector<Eigen::Vector3d>(points.size(), {0, 0, 0}));
  EXPECT_FALSE(align(found).has_value());
  found->pose.inliers = options_.enough_inliers;
  const auto stands = align(found);
  ASSERT_TRUE(stands.has_value());
  EXPECT_EQ(stands->matches.size(), 24);
}

TEST_F(SurfaceTrackerTest, LandmarksAreLookedForWhereSurfacesPutTheCamera) {
  enter(Room::corner);
  const Points points = point_grid(8, 5, -0.1);
  const std::vector<LandmarkId> landmarks = [&] {
    std::vector<LandmarkId> ids;
    FrameState view = world_.frame({}, points, corner_room());
    const KeyframeId id = world_.keep(view, {});
    for (std::size_t i = 0; i < points.size(); ++i)
      ids.push_back(
          add_landmark(world_.map, points[i], static_cast<int>(i), {{id, static_cast<std::uint16_t>(i)}}));
    keyframe_ = id;
    return ids;
  }();
  now_ = world_.frame(truth_, points, corner_room());
  FrameState last = world_.frame({}, {}, {});
  world_.follow(last, {}, keyframe_);
  const auto held = align();
  ASSERT_TRUE(held.has_value());
  EXPECT_EQ(held->surface_reference, keyframe_);
  EXPECT_EQ(held->matches.landmarks().size(), landmarks.size());
  EXPECT_LT(way_m(held->pose.world_from_camera, truth_), 0.002);
}

}  // namespace
}  // namespace vsgraphs
