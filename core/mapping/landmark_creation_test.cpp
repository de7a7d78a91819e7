#include "core/mapping/landmark_creation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_map.h"
#include "core/matching/appearance.h"

namespace vsgraphs {
namespace {

using namespace test;

using ::testing::IsEmpty;
using ::testing::SizeIs;

class LandmarkCreationTest : public ::testing::Test {
 protected:
  KeyframeId add(const Se3& pose, bool with_depth) {
    Keyframe keyframe = keyframe_seeing(camera_, pose, points_);
    keyframe.frame_index = 42;
    return add_keyframe(map_, with_features_changed(keyframe, camera_, [with_depth](auto& features) {
                          for (Feature& f : features)
                            if (!with_depth) f.depth_m = 0;
                        }));
  }
  // The landmarks made lie on their points and are known to their keyframes.
  void expect_exact(const Map& map, const std::vector<LandmarkId>& made, std::size_t observers) const {
    for (const LandmarkId id : made) {
      const Landmark& landmark = *map.landmarks().find(id);
      ASSERT_THAT(landmark.observations, SizeIs(observers));
      const std::uint16_t i = landmark.observations.front().feature;
      EXPECT_LT((landmark.point_in_world - points_[i]).norm(), 2e-3) << "point " << i;
      EXPECT_EQ(landmark.appearance.descriptor, descriptor_of(i));
      EXPECT_EQ(landmark.created_at_frame, 42);
      for (const Observation& o : landmark.observations)
        EXPECT_EQ(map.keyframes().find(o.keyframe)->landmarks[o.feature], id);
    }
  }

  Camera camera_;
  ScalePyramid pyramid_;
  Points points_ = point_grid(6, 5);
  Map map_;
};

TEST_F(LandmarkCreationTest, DepthGivesALandmarkPerFreeFeature) {
  const KeyframeId id = add(standing_at(0.3, -0.2, 0.1), true);
  const LandmarkId present = add_landmark(map_, points_[4], 4, {{id, 4}});
  Draft draft(map_.snapshot());
  const auto made = create_from_depth(camera_, id, draft);
  EXPECT_THAT(made, SizeIs(29));
  expect_exact(draft.map(), made, 1);
  EXPECT_EQ(draft.map().keyframes().find(id)->landmarks[4], present);
}

TEST_F(LandmarkCreationTest, WithoutDepthNoneIsMadeFromIt) {
  const KeyframeId id = add(standing_at(0), false);
  Draft draft(map_.snapshot());
  EXPECT_THAT(create_from_depth(camera_, id, draft), IsEmpty());
}

TEST_F(LandmarkCreationTest, TwoViewsTellWhereAPointIs) {
  const KeyframeId a = add(standing_at(-0.15), false), b = add(standing_at(0.15, 0.05), false);
  Draft draft(map_.snapshot());
  const auto made = create_by_triangulation(camera_, pyramid_, b, {a}, draft);
  EXPECT_GT(made.size(), 20U);
  expect_exact(draft.map(), made, 2);
}

TEST_F(LandmarkCreationTest, ViewsFromOnePlaceTellNothing) {
  const KeyframeId a = add(standing_at(0), false), b = add(standing_at(0.02), false);
  Draft draft(map_.snapshot());
  EXPECT_THAT(create_by_triangulation(camera_, pyramid_, b, {a}, draft), IsEmpty());
}

TEST_F(LandmarkCreationTest, FeaturesWithDepthAreLeftToTheirDepth) {
  const KeyframeId a = add(standing_at(-0.15), false), b = add(standing_at(0.15), true);
  Draft draft(map_.snapshot());
  EXPECT_THAT(create_by_triangulation(camera_, pyramid_, b, {a}, draft), IsEmpty());
}

TEST_F(LandmarkCreationTest, AppearanceIsThatOfItsObservers) {
  const KeyframeId a = add(standing_at(-1), true), b = add(standing_at(1), true);
  const Eigen::Vector3d point(0, 0, 2);
  const LandmarkId id = add_landmark(map_, point, 99, {{a, 7}, {b, 7}});
  const auto appearance = summarise_appearance(map_, *map_.landmarks().find(id));
  ASSERT_TRUE(appearance.has_value());
  EXPECT_LT((appearance->view_direction - Eigen::Vector3f::UnitZ()).norm(), 1e-6F)
      << "the mean of both sides";
  EXPECT_NEAR(appearance->reference_distance_m, std::sqrt(5.0), 1e-5);
  EXPECT_EQ(appearance->descriptor, descriptor_of(7));
}

TEST_F(LandmarkCreationTest, WhatNobodyObservesHasNoAppearance) {
  Landmark landmark;
  landmark.point_in_world = {0, 0, 2};
  EXPECT_FALSE(summarise_appearance(map_, landmark).has_value());
  landmark.observations = {{KeyframeId{50, 0}, 0}};
  EXPECT_FALSE(summarise_appearance(map_, landmark).has_value());
}

}  // namespace
}  // namespace vsgraphs
