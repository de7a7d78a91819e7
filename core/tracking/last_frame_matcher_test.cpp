#include "core/tracking/last_frame_matcher.h"

#include <gtest/gtest.h>

#include "core/tracking/test_tracking_world.h"

namespace vsgraphs {
namespace {

using namespace test;

// The last frame stood at the origin and hangs on a keyframe there, which observes the first half of the points.
class LastFrameMatcherTest : public ::testing::Test {
 protected:
  LastFrameMatcherTest() {
    FrameState there = world_.frame({}, points_, {});
    keyframe_ = world_.keep(there, {});
    for (std::size_t i = 0; i < points_.size() / 2; ++i) {
      there.landmarks[i] = add_landmark(world_.map, points_[i], static_cast<int>(i),
                                        {{keyframe_, static_cast<std::uint16_t>(i)}});
    }
    there.index = 1000;  // another frame than the keyframe's
    world_.follow(there, {}, keyframe_);
  }
  std::optional<FirstPose> match(const Se3& truth, const Se3& predicted, int first_name = 0) {
    now_ = world_.frame(truth, points_, {}, first_name);
    return matcher_.match(world_.step(now_, predicted), nullptr);
  }

  Points points_ = point_grid(10, 8);
  TrackingWorld world_;
  TrackerOptions options_;
  Recovery recovery_{options_.recovery, world_.camera, world_.pyramid, 1};
  LastFrameMatcher matcher_{options_, world_.camera, world_.pyramid, recovery_};
  KeyframeId keyframe_;
  FrameState now_;
};

TEST_F(LastFrameMatcherTest, LandmarksAndBareReadingsAreFoundWhereTheyArePredicted) {
  const Se3 truth(so3_exp({0.005, -0.01, 0.01}), {0.05, -0.02, 0.03});
  const auto first = match(truth, standing_at(0.04, -0.02, 0.02));
  ASSERT_TRUE(first.has_value());
  EXPECT_FALSE(first->guessed);
  const MatchedPose& found = first->found;
  EXPECT_LT(way_m(found.pose.world_from_camera, truth), 1e-3);
  EXPECT_EQ(found.matches.size(), 80);
  EXPECT_EQ(found.matches.landmarks().size(), 40U);
  for (const Correspondence& c : found.matches.all()) {
    EXPECT_EQ(c.landmark.valid(), c.feature < 40);
    EXPECT_LT((c.point_in_world - points_[static_cast<std::size_t>(c.feature)]).norm(), 1e-5);
  }
}

// 25 px off: outside the first search, inside the second.
TEST_F(LastFrameMatcherTest, APoorPredictionIsSearchedAroundMoreWidely) {
  const auto first = match(standing_at(0.1), {});
  ASSERT_TRUE(first.has_value());
  EXPECT_FALSE(first->guessed);
  EXPECT_LT(way_m(first->found.pose.world_from_camera, standing_at(0.1)), 1e-3);
}

TEST_F(LastFrameMatcherTest, WherePredictionFailsDescriptorsAloneTellAndThatIsSaid) {
  const auto first = match(standing_at(0.5), {});
  ASSERT_TRUE(first.has_value());
  EXPECT_TRUE(first->guessed);
  EXPECT_LT(way_m(first->found.pose.world_from_camera, standing_at(0.5)), 1e-3);
}

TEST_F(LastFrameMatcherTest, AnotherPlaceIsNotFound) {
  EXPECT_FALSE(match(standing_at(0.05), standing_at(0.05), 1000).has_value());
}

// The last frame's readings say otherwise.
TEST_F(LastFrameMatcherTest, LandmarksStandWhereTheMapHasThem) {
  const Eigen::Vector3d moved(0.05, 0, 0);
  for (std::size_t i = 0; i < 40; ++i)
    world_.map.apply(MoveLandmark{world_.last.state().landmarks[i], points_[i] + moved});
  const auto first = match({}, {});
  ASSERT_TRUE(first.has_value());
  const std::vector<LandmarkId> found = first->found.matches.landmarks();
  ASSERT_FALSE(found.empty());
  for (const Correspondence& c : first->found.matches.all()) {
    const Eigen::Vector3d expected =
        points_[static_cast<std::size_t>(c.feature)] + (c.landmark.valid() ? moved : Eigen::Vector3d::Zero());
    EXPECT_LT((c.point_in_world - expected).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace vsgraphs
