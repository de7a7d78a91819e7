#include "core/tracking/local_map_matcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/tracking/test_tracking_world.h"

namespace vsgraphs {
namespace {

using namespace test;

// One keyframe at the origin that observes all 80 points.
class LocalMapMatcherTest : public ::testing::Test {
 protected:
  LocalMapMatcherTest() {
    keyframe_ = world_.keep(world_.frame({}, points_, {}), {});
    landmarks_ = add_landmarks(world_.map, points_, {keyframe_});
    now_ = world_.frame(truth_, points_, {});
  }
  // The first `count` are matched already.
  MatchedPose guess(std::size_t count, const Se3& world_from_camera) const {
    MatchedPose guess;
    guess.matches = TrackingWorld::matches(
        now_, {landmarks_.begin(), landmarks_.begin() + static_cast<std::ptrdiff_t>(count)}, points_);
    guess.pose.world_from_camera = world_from_camera;
    return guess;
  }
  std::optional<MatchedPose> refine(MatchedPose from, double radius_px = 5) {
    return matcher_.refine(world_.map, now_, std::move(from), keyframe_, radius_px);
  }

  Points points_ = point_grid(10, 8);
  TrackingWorld world_;
  TrackerOptions options_;
  LocalMapMatcher matcher_{options_, world_.camera, world_.pyramid};
  Se3 truth_{so3_exp({0.01, -0.02, 0.01}), {0.05, -0.02, 0.03}};
  KeyframeId keyframe_;
  std::vector<LandmarkId> landmarks_;
  FrameState now_;
};

TEST_F(LocalMapMatcherTest, WhatLiesAroundIsFoundAndSharpensThePose) {
  const Se3 off = truth_ * standing_at(0.01);
  const auto found = refine(guess(25, off));
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(way_m(found->pose.world_from_camera, truth_), 1e-4);
  EXPECT_EQ(found->pose.inliers, 80);
  EXPECT_EQ(found->matches.landmarks().size(), 80U);
  EXPECT_EQ(matcher_.local_map().reference(), keyframe_);
  EXPECT_EQ(matcher_.local_map().reference_votes(), 25);
}

TEST_F(LocalMapMatcherTest, OnlyWithinTheRadius) {
  const Se3 off = truth_ * standing_at(0.05);  // 13 px
  EXPECT_EQ(refine(guess(25, off), 5)->matches.size(), 25);
  EXPECT_EQ(refine(guess(25, off), 20)->matches.size(), 80);
}

TEST_F(LocalMapMatcherTest, WithoutVotesTheKeyframeNearbyStandsIn) {
  const auto found = refine(guess(0, truth_));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->matches.size(), 80);
}

TEST_F(LocalMapMatcherTest, BareReadingsCarryOnlyWhereTheMapIsThin) {
  const auto with_bare_readings = [&](std::size_t mapped) {
    MatchedPose start = guess(0, truth_);
    for (std::size_t i = 0; i < 80; ++i)
      start.matches.add({static_cast<int>(i), i < mapped ? landmarks_[i] : LandmarkId{}, points_[i]});
    return refine(std::move(start))->matches;
  };
  EXPECT_EQ(with_bare_readings(40).size(), 40);
  EXPECT_EQ(with_bare_readings(39).size(), 80);
}

TEST_F(LocalMapMatcherTest, TooFewMatchesAreNoPose) {
  now_ = world_.frame(truth_, Points(points_.begin(), points_.begin() + 19), {});
  EXPECT_FALSE(refine(guess(10, truth_)).has_value());
}

// 24 matches stand; the others say as often that the camera is to the left as to the right.
TEST_F(LocalMapMatcherTest, APoseThatMostMatchesContradictIsACoincidence) {
  const Points shown = point_grid(14, 10);
  now_ = world_.frame(truth_, shown, {}, 1000);
  for (const std::size_t count : {90, 100}) {
    MatchedPose start = guess(0, truth_);
    start.matches.reset(now_.features->size());
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d off(i % 2 == 0 ? 0.2 : -0.2, 0, 0);
      start.matches.add({static_cast<int>(i), {}, i < 24 ? shown[i] : Eigen::Vector3d(shown[i] + off)});
    }
    EXPECT_EQ(refine(std::move(start)).has_value(), count == 90) << count;
  }
}

// What counts against landmarks that are never found.
TEST_F(LocalMapMatcherTest, ExpectsAllLandmarksInViewFoundOrNot) {
  add_landmark(world_.map, {0.1, 0.1, 2}, 5000, {{world_.keep(world_.frame({}, points_, {}), {}), 0}});
  refine(guess(25, truth_));
  EXPECT_EQ(matcher_.expected().size(), 80U);
  now_ = world_.frame(truth_, Points(points_.begin(), points_.begin() + 30), {});
  refine(guess(25, truth_));
  EXPECT_EQ(matcher_.expected().size(), 80U);
  refine(guess(25, truth_ * standing_at(1.2)));
  EXPECT_LT(matcher_.expected().size(), 60U);
}

TEST_F(LocalMapMatcherTest, AroundAKeyframeNothingNeedsToBeMatchedBefore) {
  const FrameMatches matches = matcher_.match_around(world_.map, now_, keyframe_, truth_);
  EXPECT_THAT(matches.landmarks(), ::testing::UnorderedElementsAreArray(landmarks_));
  EXPECT_EQ(matcher_.match_around(world_.map, now_, keyframe_, truth_ * standing_at(0.1)).size(), 0)
      << "26 px away";
}

}  // namespace
}  // namespace vsgraphs
