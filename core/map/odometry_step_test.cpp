// What becomes of measured odometry when keyframes go.
#include <gtest/gtest.h>

#include "core/geometry/pose_covariance.h"
#include "core/map/map_checks.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

class OdometrySteps : public ::testing::Test {
 protected:
  OdometrySteps() {
    for (int i = 0; i < 4; ++i)
      ids_.push_back(add_keyframe(map_, keyframe_seeing(camera_, standing_at(i), points_)));
    map_.apply(SetOdometry{ids_[0], {}});
    for (std::size_t i = 1; i < 4; ++i) map_.apply(SetOdometry{ids_[i], step(i)});
  }
  OdometryStep step(std::size_t i) const {
    Vector6d variances;
    variances << 1, 2, 3, 0.1, 0.2, 0.3;
    const double k = static_cast<double>(i);
    return {ids_[i - 1], Se3(so3_exp({0.1, 0.2 * k, 0}), {k, 0.5, 0.1}),
            k * 1e-4 * Matrix6d(variances.asDiagonal())};
  }
  const std::optional<OdometryStep>& odometry(std::size_t i) const {
    return map_.keyframes().find(ids_[i])->odometry;
  }

  Camera camera_;
  Points points_ = point_grid(3, 2);
  Map map_;
  std::vector<KeyframeId> ids_;
};

TEST_F(OdometrySteps, GoOverACulledKeyframeWithTheErrorsOfBoth) {
  map_.apply(RemoveKeyframe{ids_[2], ids_[0]});
  ASSERT_TRUE(odometry(3).has_value());
  EXPECT_EQ(odometry(3)->before, ids_[1]);
  const Se3 expected = step(2).before_from_camera * step(3).before_from_camera;
  EXPECT_TRUE(odometry(3)->before_from_camera.matrix().isApprox(expected.matrix(), 1e-12));
  EXPECT_TRUE(odometry(3)->covariance.isApprox(
      compose_covariance(step(2).covariance, step(3).before_from_camera, step(3).covariance)));
  map_.apply(RemoveKeyframe{ids_[1], ids_[0]});
  EXPECT_EQ(odometry(3)->before, ids_[0]);
  const Se3 all = step(1).before_from_camera * expected;
  EXPECT_TRUE(odometry(3)->before_from_camera.matrix().isApprox(all.matrix(), 1e-12));
}

TEST_F(OdometrySteps, EndWhereTheCulledKeyframeHadNone) {
  map_.apply(RemoveKeyframe{ids_[0], ids_[1]});
  ASSERT_TRUE(odometry(1).has_value()) << "a gap is known, and not measured again";
  EXPECT_FALSE(odometry(1)->before.valid());
  EXPECT_EQ(odometry(2)->before, ids_[1]);
}

TEST_F(OdometrySteps, AreMeasuredAnewWhereTheCulledKeyframeWaitedForIts) {
  const KeyframeId waiting = add_keyframe(map_, keyframe_seeing(camera_, standing_at(4), points_));
  const KeyframeId last = add_keyframe(map_, keyframe_seeing(camera_, standing_at(5), points_));
  map_.apply(SetOdometry{last, {waiting, standing_at(1), Matrix6d::Identity()}});
  map_.apply(RemoveKeyframe{waiting, ids_[3]});
  EXPECT_FALSE(map_.keyframes().find(last)->odometry.has_value());
}

// However long the way, the map can be saved.
TEST_F(OdometrySteps, EndWhereNothingIsKnownAnyMoreOfTheWhole) {
  for (std::size_t i = 1; i < 4; ++i) {
    OdometryStep loose = step(i);
    loose.covariance = Vector6d::Constant(4e5).asDiagonal();
    map_.apply(SetOdometry{ids_[i], loose});
  }
  map_.apply(RemoveKeyframe{ids_[2], ids_[0]});
  EXPECT_STREQ(wrong_with_values(map_), nullptr);
  ASSERT_TRUE(odometry(3).has_value());
  EXPECT_FALSE(odometry(3)->before.valid());
}

TEST_F(OdometrySteps, OverManyCulledKeyframesAreStillGood) {
  std::vector<KeyframeId> more = ids_;
  for (int i = 4; i < 60; ++i) {
    more.push_back(add_keyframe(map_, keyframe_seeing(camera_, standing_at(i), points_)));
    Matrix6d covariance = Matrix6d::Identity() * 0.3;
    covariance(0, 5) = covariance(5, 0) = 0.1;
    map_.apply(SetOdometry{
        more.back(), {more[more.size() - 2], Se3(so3_exp({0.3, 0.2, 0.1}), {0.7, 0.5, 0.1}), covariance}});
  }
  for (std::size_t i = 2; i + 1 < more.size(); ++i) {
    map_.apply(RemoveKeyframe{more[i], more[0]});
    ASSERT_STREQ(wrong_with_values(map_), nullptr) << i;
  }
  EXPECT_EQ(map_.keyframes().find(more.back())->odometry->before, more[1]);
}

TEST_F(OdometrySteps, AreNoneOfTheMapsPoses) {
  map_.apply(MoveKeyframe{ids_[1], standing_at(7, 8, 9)});
  map_.apply(MoveKeyframe{ids_[2], standing_at(-7, 8, 9)});
  EXPECT_EQ(odometry(2)->before_from_camera.matrix(), step(2).before_from_camera.matrix());
}

TEST_F(OdometrySteps, CannotBeginAtWhatIsGoneOrAtThemselves) {
  map_.apply(RemoveKeyframe{ids_[1], ids_[0]});
  const Eigen::Matrix4d as_it_was = odometry(2)->before_from_camera.matrix();
  map_.apply(SetOdometry{ids_[2], {ids_[1], Se3{}, Matrix6d::Identity()}});
  map_.apply(SetOdometry{ids_[2], {ids_[2], Se3{}, Matrix6d::Identity()}});
  map_.apply(SetOdometry{ids_[1], {ids_[0], Se3{}, Matrix6d::Identity()}});
  EXPECT_EQ(odometry(2)->before_from_camera.matrix(), as_it_was);
}

TEST_F(OdometrySteps, CountInAnEditsHash) {
  const auto hash = [](const OdometryStep& s) { return MapEdit{0, {SetOdometry{{1, 0}, s}}}.hash(); };
  OdometryStep other = step(1);
  other.covariance(3, 2) += 1e-12;
  EXPECT_EQ(hash(step(1)), hash(step(1)));
  EXPECT_NE(hash(step(1)), hash(other));
}

}  // namespace
}  // namespace vsgraphs
