#include "core/map/stretch.h"

#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

// Keyframes 2 m apart along a wall of points, each of which sees the points of the one before.
class StretchTest : public ::testing::Test {
 protected:
  KeyframeId go_to(double x, bool tied = true, std::optional<TrackedLink> link = {}) {
    Keyframe keyframe = keyframe_seeing(camera_, standing_at(x), points_);
    keyframe.tracked_link = link;
    keyframe.stretch = stretch_going_on(map_, standing_at(x), tied ? landmarks_ : std::vector<LandmarkId>{},
                                        link, usual_stretch_m);
    const KeyframeId id = add_keyframe(map_, keyframe);
    landmarks_ = add_landmarks(map_, points_, {id});
    return id;
  }

  Camera camera_;
  Points points_ = point_grid(6, 5);
  std::vector<LandmarkId> landmarks_;
  Map map_;
};

TEST_F(StretchTest, GoesOnForSoManyMetresOfWay) {
  const KeyframeId first = go_to(0);
  for (int i = 1; i <= 7; ++i) EXPECT_EQ(map_.stretch_of(go_to(2 * i)), first) << i;
  const KeyframeId next = go_to(16);
  EXPECT_EQ(map_.stretch_of(next), next);
  EXPECT_EQ(map_.stretch_of(go_to(18)), next);
}

TEST_F(StretchTest, EndsWhereNothingTiesTheNextKeyframeToIt) {
  const KeyframeId first = go_to(0);
  const KeyframeId lost = go_to(1, false);
  EXPECT_EQ(map_.stretch_of(lost), lost);
  const KeyframeId linked = go_to(1.5, false, TrackedLink{lost, standing_at(0.5), Matrix6d::Identity()});
  EXPECT_EQ(map_.stretch_of(linked), lost);
  const KeyframeId elsewhere = go_to(2, false, TrackedLink{first, standing_at(2), Matrix6d::Identity()});
  EXPECT_EQ(map_.stretch_of(elsewhere), elsewhere) << "linked to another stretch";
}

TEST_F(StretchTest, ARetiredKeyframeStaysInItsStretchWhoseFrameItCarries) {
  const KeyframeId first = go_to(0), second = go_to(1);
  map_.apply(RemoveKeyframe{first, second});
  EXPECT_EQ(map_.stretch_of(first), first);
  EXPECT_EQ(map_.stretch_of(second), first);
  map_.apply(MoveKeyframe{second, standing_at(1, 2, 3)});
  EXPECT_TRUE(world_from_stretch(map_, first)->translation().isApprox(Eigen::Vector3d(0, 2, 3)));
  EXPECT_FALSE(world_from_stretch(map_, KeyframeId{9, 0}));
  EXPECT_FALSE(map_.stretch_of(KeyframeId{9, 0}).valid());
}

TEST_F(StretchTest, AMapWithoutStretchesIsCutByItsWay) {
  std::vector<KeyframeId> all;
  for (int i = 0; i < 10; ++i) all.push_back(go_to(2 * i, false));
  map_.apply(RemoveKeyframe{all[1], all[0]});
  map_.cut_into_stretches(5);
  EXPECT_EQ(map_.stretch_of(all[1]), all[0]);
  EXPECT_EQ(map_.stretch_of(all[2]), all[0]);
  EXPECT_EQ(map_.stretch_of(all[3]), all[3]);
  EXPECT_EQ(map_.stretch_of(all[9]), all[9]);
}

}  // namespace
}  // namespace vsgraphs
