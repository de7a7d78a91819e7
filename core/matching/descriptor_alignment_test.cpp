#include "core/matching/descriptor_alignment.h"

#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

// A keyframe at the origin sees 60 points; the view to be aligned sees them 0.4 m further right, turned a little.
class DescriptorAlignerTest : public ::testing::Test {
 protected:
  std::optional<MatchedPose> align(const Keyframe& there, const Keyframe& now, int min_inliers = 20) const {
    return aligner_.align(map_, posed_view(there), *now.features, min_inliers, Rng(1, "test", 0));
  }
  static double gap(const Se3& a, const Se3& b) { return (a.inverse() * b).log().norm(); }
  // Every third point appears elsewhere.
  Keyframe with_wrong_matches(Keyframe view) const {
    return with_features_changed(std::move(view), camera_, [](std::vector<Feature>& features) {
      for (std::size_t i = 0; i < features.size(); i += 3) features[i].u = 639 - features[i].u;
    });
  }

  Camera camera_;
  ScalePyramid pyramid_;
  Points points_ = point_grid(10, 6);
  Map map_;
  Keyframe there_ = keyframe_seeing(camera_, Se3{}, points_);
  Se3 truth_{so3_exp({0.02, -0.1, 0.05}), {0.4, 0.1, -0.2}};
  Keyframe now_ = keyframe_seeing(camera_, truth_, points_);
  DescriptorAligner aligner_{camera_, pyramid_};
};

TEST_F(DescriptorAlignerTest, DepthReadingsAloneGiveThePose) {
  there_.landmarks.resize(points_.size());
  const auto found = align(there_, now_);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(gap(found->pose.world_from_camera, truth_), 1e-4);
  EXPECT_EQ(found->pose.inliers, static_cast<int>(points_.size()));
  EXPECT_TRUE(found->pose.trustworthy);
  for (const Correspondence& c : found->matches.all()) {
    EXPECT_FALSE(c.landmark.valid());
    EXPECT_LT((c.point_in_world - points_[static_cast<std::size_t>(c.feature)]).norm(), 1e-5);
  }
}

// The map knows better where a landmark is than one view's depth; bare readings fill in.
TEST_F(DescriptorAlignerTest, LandmarksStandWhereTheMapHasThem) {
  const Se3 moved = standing_at(0, 0, 0.3);
  const KeyframeId id = add_keyframe(map_, there_);
  std::vector<LandmarkId> landmarks(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    landmarks[i] =
        add_landmark(map_, moved * points_[i], static_cast<int>(i), {{id, static_cast<std::uint16_t>(i)}});
  }
  there_.landmarks = landmarks;
  const auto found = align(there_, now_);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(gap(found->pose.world_from_camera, moved * truth_), 1e-4);
  for (const Correspondence& c : found->matches.all())
    EXPECT_EQ(c.landmark, landmarks[static_cast<std::size_t>(c.feature)]);
}

TEST_F(DescriptorAlignerTest, WhatHasNeitherLandmarkNorDepthIsNoMatch) {
  there_.landmarks.resize(points_.size());
  there_ = with_features_changed(there_, camera_, [](std::vector<Feature>& features) {
    for (std::size_t i = 0; i < 25; ++i) features[i].depth_m = 0;
  });
  const auto found = align(there_, now_);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->matches.size(), 35);
  for (const Correspondence& c : found->matches.all()) EXPECT_GE(c.feature, 25);
}

TEST_F(DescriptorAlignerTest, WrongMatchesAreDropped) {
  there_.landmarks.resize(points_.size());
  const auto found = align(there_, with_wrong_matches(now_));
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(gap(found->pose.world_from_camera, truth_), 1e-4);
  EXPECT_EQ(found->matches.size(), found->pose.inliers);
  EXPECT_LT(found->matches.size(), 50);
  for (int i = 0; i < now_.features->size(); ++i) EXPECT_TRUE(i % 3 == 0 || found->matches.taken(i)) << i;
}

TEST_F(DescriptorAlignerTest, TooFewThatAgreeAreNoPose) {
  there_.landmarks.resize(points_.size());
  const Keyframe doubtful = with_wrong_matches(now_);
  EXPECT_TRUE(align(there_, doubtful, 40).has_value());
  EXPECT_FALSE(align(there_, doubtful, 55).has_value());
}

TEST_F(DescriptorAlignerTest, AnotherPlaceIsNotRecognised) {
  there_.landmarks.resize(points_.size());
  EXPECT_FALSE(align(there_, keyframe_seeing(camera_, truth_, points_, 1000)).has_value());
}

// All on one line: nothing tells the turn about it.
TEST_F(DescriptorAlignerTest, PointsThatDoNotHoldThePoseAreNone) {
  Points line;
  for (int i = 0; i < 40; ++i) line.emplace_back(0.02 * i - 0.4, 0, 2.0);
  Keyframe there = keyframe_seeing(camera_, Se3{}, line);
  there.landmarks.resize(line.size());
  EXPECT_FALSE(align(there, keyframe_seeing(camera_, standing_at(0.1), line)).has_value());
}

}  // namespace
}  // namespace vsgraphs
