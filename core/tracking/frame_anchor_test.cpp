#include "core/tracking/frame_anchor.h"

#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

// A frame that matched `count` landmarks of keyframe `seen_`; it hangs on `near_` where nothing speaks for another.
class FrameAnchorTest : public ::testing::Test {
 protected:
  void match(std::size_t count) {
    now_.features = keyframe_seeing(camera_, {}, points_).features;
    now_.landmarks.assign(points_.size(), {});
    found_.matches.reset(now_.features->size());
    for (std::size_t i = 0; i < count; ++i)
      found_.matches.add({static_cast<int>(i), landmarks_[i], points_[i]});
    local_map_.select(map_, found_.matches.landmarks(), near_, 5);
  }
  KeyframeId chosen() const { return choose_anchor(local_map_, found_, near_); }

  Camera camera_;
  Points points_ = point_grid(6, 4);
  Map map_;
  KeyframeId near_ = add_keyframe(map_, keyframe_seeing(camera_, {}, points_));
  KeyframeId seen_ = add_keyframe(map_, keyframe_seeing(camera_, standing_at(1), points_));
  std::vector<LandmarkId> landmarks_ = add_landmarks(map_, points_, {seen_});
  LocalMap local_map_;
  MatchedPose found_;
  FrameState now_;
};

TEST_F(FrameAnchorTest, AFrameHangsOnTheKeyframeWhoseLandmarksItMatched) {
  match(15);
  EXPECT_EQ(chosen(), seen_);
}

TEST_F(FrameAnchorTest, AHandfulOfVotesIsNoHold) {
  match(14);
  EXPECT_EQ(chosen(), near_);
}

TEST_F(FrameAnchorTest, SurfacesThatHeldThePoseComeFirst) {
  match(20);
  found_.surface_reference = near_;
  EXPECT_EQ(chosen(), near_);
}

TEST_F(FrameAnchorTest, TheFrameTakesWhatWasFound) {
  match(20);
  found_.matches.add({21, LandmarkId{}, points_[21]});
  found_.surface_reference = near_;
  found_.pose.world_from_camera = standing_at(1.3, 0.2);
  anchor_frame(map_, seen_, found_, now_);
  EXPECT_EQ(now_.pose.keyframe, seen_);
  EXPECT_LT((now_.pose.keyframe_from_camera.translation() - Eigen::Vector3d(0.3, 0.2, 0)).norm(), 1e-12);
  EXPECT_EQ(now_.surface_reference, near_);
  EXPECT_EQ(now_.matched_landmarks(), 20);
  EXPECT_EQ(now_.landmarks[19], landmarks_[19]);
  EXPECT_FALSE(now_.landmarks[21].valid());
}

TEST_F(FrameAnchorTest, FewLandmarksNeedALink) {
  match(20);
  found_.pose.world_from_camera = standing_at(1.3);
  anchor_frame(map_, seen_, found_, now_);
  EXPECT_FALSE(link_to_anchor(now_, Matrix6d::Identity(), 20).has_value());
  const auto link = link_to_anchor(now_, 3 * Matrix6d::Identity(), 21);
  ASSERT_TRUE(link.has_value());
  EXPECT_EQ(link->to, seen_);
  EXPECT_NEAR(link->to_from_camera.translation().x(), 0.3, 1e-12);
  EXPECT_EQ(link->information(2, 2), 3);
}

}  // namespace
}  // namespace vsgraphs
