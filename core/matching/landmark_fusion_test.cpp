#include "core/matching/landmark_fusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

// Two keyframes that see the same twenty points. Each has made landmarks of its own.
class LandmarkFusionTest : public ::testing::Test {
 protected:
  LandmarkFusionTest() {
    left_ = add_keyframe(map_, keyframe_seeing(camera_, standing_at(0), points_));
    right_ = add_keyframe(map_, keyframe_seeing(camera_, standing_at(0.2), points_));
  }
  LandmarkId add(KeyframeId keyframe, int point, const Eigen::Vector3d& off = {0, 0, 0}) {
    const auto i = static_cast<std::uint16_t>(point);
    return add_landmark(map_, points_[i] + off, point, {{keyframe, i}});
  }
  LandmarkId landmark_of(const Map& map, KeyframeId keyframe, int feature) const {
    return map.keyframes().find(keyframe)->landmarks[static_cast<std::size_t>(feature)];
  }
  Map fused() {
    Draft draft(map_.snapshot());
    fuse_into_neighbours(camera_, pyramid_, right_, {left_}, draft);
    return draft.map();
  }
  Map observed() {
    Draft draft(map_.snapshot());
    observe_neighbours_landmarks(camera_, pyramid_, right_, {left_}, draft);
    return draft.map();
  }
  // The left keyframe with another reading at one feature.
  void change_left(int feature, float depth_m) {
    left_ = add_keyframe(map_, with_features_changed(*map_.keyframes().find(left_), camera_, [&](auto& f) {
                           f[static_cast<std::size_t>(feature)].depth_m = depth_m;
                         }));
  }

  Camera camera_;
  ScalePyramid pyramid_;
  Points points_ = point_grid(5, 4);
  Map map_;
  KeyframeId left_, right_;
};

TEST_F(LandmarkFusionTest, TwoOfTheSamePlaceBecomeOne) {
  std::vector<LandmarkId> of_left, of_right;
  for (int i = 0; i < 20; ++i) {
    of_left.push_back(add(left_, i));
    of_right.push_back(add(right_, i, {0.004, 0, 0.01}));
  }
  const Map map = fused();
  EXPECT_EQ(map.landmarks().size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(map.landmarks().resolve(of_right[i]), of_left[i]) << "equally observed: the one that was there";
    EXPECT_EQ(map.landmarks().find(of_left[i])->observations.size(), 2U);
    EXPECT_EQ(landmark_of(map, right_, static_cast<int>(i)), of_left[i]);
  }
}

TEST_F(LandmarkFusionTest, TheBetterObservedOneStays) {
  const LandmarkId of_left = add(left_, 3), of_right = add(right_, 3);
  const KeyframeId third = add_keyframe(map_, keyframe_seeing(camera_, standing_at(0.1), points_));
  map_.apply(AddObservation{of_right, {third, 3}});
  const Map map = fused();
  EXPECT_EQ(map.landmarks().resolve(of_left), of_right);
  EXPECT_EQ(map.landmarks().find(of_right)->observations.size(), 3U);
}

TEST_F(LandmarkFusionTest, AFreeFeatureBecomesAnObservation) {
  const LandmarkId of_right = add(right_, 7);
  const Map map = fused();
  EXPECT_EQ(landmark_of(map, left_, 7), of_right);
  EXPECT_EQ(map.landmarks().find(of_right)->observations.size(), 2U);
}

TEST_F(LandmarkFusionTest, WhereDepthDisagreesTheyStayTwo) {
  // On the same pixel with the same look, but something nearer.
  change_left(3, static_cast<float>(points_[3].z() - 0.4));
  const LandmarkId of_left = add(left_, 3), of_right = add(right_, 3);
  const Map map = fused();
  EXPECT_TRUE(map.landmarks().contains(of_left));
  EXPECT_TRUE(map.landmarks().contains(of_right));
  EXPECT_EQ(landmark_of(map, right_, 3), of_right);
}

// Features without depth have nothing to say; then the landmarks must, by where they are.
TEST_F(LandmarkFusionTest, ANearAndAFarPointOfOneRayStayTwo) {
  change_left(3, 0);
  const LandmarkId of_left = add(left_, 3, 0.5 * points_[3]), of_right = add(right_, 3);
  const Map map = fused();
  EXPECT_TRUE(map.landmarks().contains(of_left));
  EXPECT_TRUE(map.landmarks().contains(of_right));
}

TEST_F(LandmarkFusionTest, WithoutDepthTwoOfTheSamePlaceBecomeOne) {
  change_left(3, 0);
  const LandmarkId of_left = add(left_, 3, 0.02 * points_[3]), of_right = add(right_, 3);
  EXPECT_EQ(fused().landmarks().resolve(of_right), of_left);
}

TEST_F(LandmarkFusionTest, DepthWithinNoiseAgrees) {
  change_left(3, static_cast<float>(points_[3].z() - 0.04));
  const LandmarkId of_left = add(left_, 3), of_right = add(right_, 3);
  EXPECT_EQ(fused().landmarks().resolve(of_right), of_left);
}

TEST_F(LandmarkFusionTest, WhatLooksDifferentStaysTwo) {
  const LandmarkId of_left = add(left_, 3);
  const LandmarkId stranger = add_landmark(map_, points_[3], 1000, {{right_, 3}});
  const Map map = fused();
  EXPECT_TRUE(map.landmarks().contains(of_left));
  EXPECT_TRUE(map.landmarks().contains(stranger));
}

TEST_F(LandmarkFusionTest, WhatLiesElsewhereStaysTwo) {
  const LandmarkId of_left = add(left_, 3), of_right = add(right_, 3, {0.04, 0, 0});  // 10 px
  const Map map = fused();
  EXPECT_TRUE(map.landmarks().contains(of_left));
  EXPECT_TRUE(map.landmarks().contains(of_right));
}

TEST_F(LandmarkFusionTest, NeighboursLandmarksAreSeenByFreeFeatures) {
  std::vector<LandmarkId> of_left;
  for (int i = 0; i < 20; ++i) of_left.push_back(add(left_, i));
  const LandmarkId own = add(right_, 5);
  const Map map = observed();
  EXPECT_EQ(landmark_of(map, right_, 5), own) << "features that have a landmark keep it";
  EXPECT_EQ(map.landmarks().size(), 21U);
  for (std::size_t i = 0; i < 20; ++i) {
    if (i != 5) {
      EXPECT_EQ(landmark_of(map, right_, static_cast<int>(i)), of_left[i]);
    }
  }
}

TEST_F(LandmarkFusionTest, NeighboursLandmarksAtAnotherDepthAreNotSeen) {
  // 0.5 m behind the point, on the ray that meets the right camera's pixel.
  const Eigen::Vector3d ray = points_[3] - Eigen::Vector3d(0.2, 0, 0);
  const LandmarkId behind = add(left_, 3, 0.25 * ray);
  const Map map = observed();
  EXPECT_FALSE(landmark_of(map, right_, 3).valid());
  EXPECT_EQ(map.landmarks().find(behind)->observations.size(), 1U);
}

}  // namespace
}  // namespace vsgraphs
