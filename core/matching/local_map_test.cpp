#include "core/matching/local_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A landmark 2 m ahead of the origin, seen from there at pyramid level 2.
class ProjectionTest : public ::testing::Test {
 protected:
  ProjectionTest() {
    landmark_.point_in_world = {0, 0, 2};
    landmark_.appearance.reference_distance_m = 2.0F;
    landmark_.appearance.reference_level = 2;
  }
  bool seen_from(const Se3& world_from_camera) {
    return project_landmark(camera_, pyramid_, world_from_camera.inverse(), {5, 0}, landmark_, 4.0, view_);
  }
  static Se3 looking(const Eigen::Vector3d& position, double turn_y) {
    return {so3_exp({0, turn_y, 0}), position};
  }

  Camera camera_;
  ScalePyramid pyramid_;
  Landmark landmark_;
  LandmarkView view_;
};

TEST_F(ProjectionTest, AppearsWhereTheCameraSaysAtTheLevelItWasSeen) {
  ASSERT_TRUE(seen_from(standing_at(0.2, -0.1)));
  EXPECT_NEAR(view_.projection.u, 319.5 - 52.5, 1e-3);
  EXPECT_NEAR(view_.projection.v, 239.5 + 26.25, 1e-3);
  EXPECT_EQ(view_.projection.min_level, 1);
  EXPECT_EQ(view_.projection.max_level, 3);
  EXPECT_NEAR(view_.projection.radius_px, 4.0 * 1.44, 1e-4);
  EXPECT_EQ(view_.projection.descriptor, &landmark_.appearance.descriptor);
  EXPECT_EQ(view_.id, (LandmarkId{5, 0}));
}

TEST_F(ProjectionTest, NotBehindTheCamera) {
  EXPECT_FALSE(seen_from(standing_at(0, 0, 2.5)));
  EXPECT_FALSE(seen_from(standing_at(0, 0, 1.97)));
}

TEST_F(ProjectionTest, NotOutsideTheImage) {
  EXPECT_TRUE(seen_from(looking({0, 0, 0}, 0.5)));
  EXPECT_FALSE(seen_from(looking({0, 0, 0}, 0.6)));
  EXPECT_FALSE(seen_from(looking({0, 0, 0}, -0.6)));
  EXPECT_TRUE(seen_from(standing_at(0, 0.9)));
  EXPECT_FALSE(seen_from(standing_at(0, 0.95)));
}

// Always in the middle of the image, at the same distance.
TEST_F(ProjectionTest, NotFromAnotherSide) {
  const auto round = [](double angle) {
    return looking({-2 * std::sin(angle), 0, 2 - 2 * std::cos(angle)}, angle);
  };
  EXPECT_TRUE(seen_from(round(1.0)));
  EXPECT_TRUE(seen_from(round(-1.0)));
  EXPECT_FALSE(seen_from(round(1.1)));
  EXPECT_FALSE(seen_from(round(-1.1)));
}

TEST_F(ProjectionTest, OnlyAtScalesThePyramidBridges) {
  // Twice as near: 1/2 = 1.2^-3.8, so it looks as level 6 did; a little farther: level 0.
  ASSERT_TRUE(seen_from(standing_at(0, 0, 1.0)));
  EXPECT_EQ(view_.projection.min_level, 5);
  EXPECT_EQ(view_.projection.max_level, 7);
  ASSERT_TRUE(seen_from(standing_at(0, 0, -0.8)));
  EXPECT_EQ(view_.projection.min_level, 0);
  EXPECT_EQ(view_.projection.max_level, 1);
  EXPECT_FALSE(seen_from(standing_at(0, 0, -1.5))) << "1.75 times as far, but only two levels to give";
  EXPECT_FALSE(seen_from(standing_at(0, 0, 1.4))) << "a third of the way, but only five levels to give";
}

// Three keyframes see the same 32 points, of which the third observes 30; a fourth is elsewhere.
class LocalMapTest : public ::testing::Test {
 protected:
  LocalMapTest() {
    const Points here = point_grid(8, 4), there = point_grid(8, 4, 5.0);
    for (int k = 0; k < 3; ++k)
      near_.push_back(add_keyframe(map_, keyframe_seeing(camera_, standing_at(0.1 * k), here)));
    far_ = add_keyframe(map_, keyframe_seeing(camera_, standing_at(5), there));
    landmarks_ = add_landmarks(map_, here, {near_[0], near_[1]});
    for (std::size_t i = 0; i < 30; ++i)
      map_.apply(AddObservation{landmarks_[i], {near_[2], static_cast<std::uint16_t>(i)}});
    far_landmarks_ = add_landmarks(map_, there, {far_});
  }
  std::vector<LandmarkId> seen(std::size_t from, std::size_t count) const {
    return {landmarks_.begin() + static_cast<std::ptrdiff_t>(from),
            landmarks_.begin() + static_cast<std::ptrdiff_t>(from + count)};
  }
  Camera camera_;
  Map map_;
  LocalMap local_;
  std::vector<KeyframeId> near_;
  KeyframeId far_;
  std::vector<LandmarkId> landmarks_, far_landmarks_;
};

TEST_F(LocalMapTest, KeyframesAreChosenByVotesAndTiesById) {
  local_.select(map_, seen(28, 4), far_, 10);
  EXPECT_THAT(local_.keyframes(), ElementsAre(near_[0], near_[1], near_[2]));
  EXPECT_EQ(local_.reference(), near_[0]);
  EXPECT_EQ(local_.reference_votes(), 4);
  EXPECT_THAT(local_.landmarks(), SizeIs(32));
}

TEST_F(LocalMapTest, TheMostVotedIsTheReference) {
  map_.apply(RemoveObservation{landmarks_[0], near_[0]});
  local_.select(map_, seen(0, 5), far_, 1);
  EXPECT_THAT(local_.keyframes(), ElementsAre(near_[1]));
  EXPECT_EQ(local_.reference(), near_[1]);
}

TEST_F(LocalMapTest, WithoutVotesTheFallbackAndItsNeighboursServe) {
  local_.select(map_, {}, far_, 10);
  EXPECT_THAT(local_.keyframes(), ElementsAre(far_));
  EXPECT_THAT(local_.landmarks(), far_landmarks_);
  EXPECT_EQ(local_.reference_votes(), 0);
  local_.select(map_, {}, near_[2], 10);
  EXPECT_THAT(local_.keyframes(), ElementsAre(near_[2], near_[0], near_[1]));
}

TEST_F(LocalMapTest, VanishedLandmarksAndKeyframesAreNoProblem) {
  const auto gone = seen(0, 5);
  for (const LandmarkId id : gone) map_.apply(RemoveLandmark{id});
  local_.select(map_, gone, KeyframeId{77, 0}, 10);
  EXPECT_THAT(local_.keyframes(), IsEmpty());
  EXPECT_THAT(local_.landmarks(), IsEmpty());
  EXPECT_FALSE(local_.reference().valid());
  EXPECT_EQ(local_.reference_votes(), 0);
}

TEST_F(LocalMapTest, SelectionsDoNotLeakIntoTheNext) {
  local_.select(map_, seen(0, 10), far_, 10);
  local_.select(map_, std::span(far_landmarks_).first(3), near_[0], 10);
  EXPECT_THAT(local_.landmarks(), far_landmarks_);
  local_.select(map_, seen(0, 10), far_, 10);
  EXPECT_THAT(local_.landmarks(), SizeIs(32));
}

}  // namespace
}  // namespace vsgraphs
