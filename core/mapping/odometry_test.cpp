#include "core/mapping/odometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/rng.h"
#include "core/geometry/pose_covariance.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using test::Points;
using test::standing_at;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double step_m = 0.3;

// Keyframes `step_m` apart in front of points that all of them see, exactly but for `noise_px`.
class Odometry : public ::testing::Test {
 protected:
  void go(int keyframes, double noise_px = 0, std::uint64_t seed = 1) {
    Rng rng(seed, "odometry_test", 0);
    for (int k = 0; k < keyframes; ++k) {
      Keyframe keyframe = test::keyframe_seeing(model_.camera, at(k), points_);
      keyframe = test::with_features_changed(keyframe, model_.camera, [&](std::vector<Feature>& features) {
        for (Feature& f : features) {
          f.u += static_cast<float>(noise_px * rng.normal());
          f.v += static_cast<float>(noise_px * rng.normal());
          f.depth_m = 0;  // but for the few that say how large things are
        }
        for (std::size_t i = 0; i < 10; ++i) {
          const double depth_m = (at(k).inverse() * points_[i]).z();
          const double sigma_m = noise_px > 0 ? model_.camera.depth_noise.feature_sigma_m(depth_m) : 0;
          features[i].depth_m = static_cast<float>(depth_m + sigma_m * rng.normal());
        }
      });
      keyframe.frame_index = k;
      if (k > 0) keyframe.stretch = ids_.front();
      ids_.push_back(test::add_keyframe(map_, keyframe));
    }
    test::add_landmarks(map_, points_, ids_);
  }
  static Se3 at(int k) { return {so3_exp({0, -0.05 * k, 0.01 * k}), {step_m * k, 0, 0}}; }
  OdometryStep measured(int k) const { return measure_step(map_, ids_[static_cast<std::size_t>(k)], model_); }
  static Vector6d error(const OdometryStep& step, int from, int to) {
    return (step.before_from_camera.inverse() * (at(from).inverse() * at(to))).log();
  }
  MapEdit measure(const std::vector<KeyframeId>& window, KeyframeId newest) {
    Draft draft(map_.snapshot());
    measure_odometry(model_, {.free = window, .fixed = {}, .landmarks = {}, .passengers = {}}, newest, draft);
    MapEdit edit = draft.take();
    map_.apply(edit);
    return edit;
  }
  static std::vector<KeyframeId> steps_of(const MapEdit& edit) {
    std::vector<KeyframeId> ids;
    for (const EditOperation& op : edit.operations) ids.push_back(std::get<SetOdometry>(op).id);
    return ids;
  }

  MeasurementModel model_;
  Points points_ = test::point_grid(9, 6, 0.6, 2.5);
  Map map_;
  std::vector<KeyframeId> ids_;
};

TEST_F(Odometry, IsWhatWasSeenAndNotWhereTheMapHasIt) {
  go(4);
  map_.apply(
      MoveKeyframe{ids_[2], at(2).retract((Vector6d() << 0.05, -0.03, 0.04, 0.02, 0, 0.01).finished())});
  const OdometryStep step = measured(2);
  EXPECT_EQ(step.before, ids_[1]);
  EXPECT_LT(error(step, 1, 2).norm(), 1e-4);
  EXPECT_GT(step.covariance.diagonal().minCoeff(), 0);
  EXPECT_LT(step.covariance.diagonal().maxCoeff(), 1e-3);
}

TEST_F(Odometry, AWrongLoopDoesNotBecomeTheOdometry) {
  go(6);
  measure({}, ids_[5]);
  const OdometryStep before = *map_.keyframes().find(ids_[2])->odometry;
  const Se3 wrong(so3_exp({0, 1.5, 0}), {7, 0, 1});
  for (const int k : {2, 3, 4, 5}) map_.apply(MoveKeyframe{ids_[static_cast<std::size_t>(k)], wrong * at(k)});
  measure({}, ids_[5]);
  const OdometryStep& after = *map_.keyframes().find(ids_[2])->odometry;
  EXPECT_EQ(before.before_from_camera.matrix(), after.before_from_camera.matrix());
  EXPECT_EQ(before.covariance, after.covariance);
}

TEST_F(Odometry, KnowsHowFarItIsOff) {
  double squared = 0;
  constexpr int draws = 20;
  for (int draw = 1; draw <= draws; ++draw) {
    map_ = Map{};
    ids_.clear();
    go(5, 1.0, static_cast<std::uint64_t>(draw));
    const OdometryStep step = measured(2);
    ASSERT_EQ(step.before, ids_[1]);
    squared += std::pow(sigmas_of(error(step, 1, 2), step.covariance), 2) / 6;
  }
  EXPECT_GT(squared / draws, 0.3);
  EXPECT_LT(squared / draws, 3);
}

TEST_F(Odometry, IsMeasuredOnceWhenAKeyframeHasLeftTheWindow) {
  go(7);
  EXPECT_THAT(steps_of(measure({ids_[2], ids_[4], ids_[6]}, ids_[6])),
              ElementsAre(ids_[0], ids_[1], ids_[3], ids_[5]));
  EXPECT_THAT(steps_of(measure({ids_[4], ids_[6]}, ids_[6])), ElementsAre(ids_[2]));
  EXPECT_THAT(steps_of(measure({ids_[4], ids_[6]}, ids_[6])), IsEmpty());
  EXPECT_FALSE(map_.keyframes().find(ids_[0])->odometry->before.valid()) << "nothing comes before the first";
  EXPECT_THAT(steps_of(measure({}, ids_[6])), ElementsAre(ids_[4])) << "the newest waits";
}

TEST_F(Odometry, AMapThatWasAwayIsCaughtUpWithPieceByPiece) {
  go(9);
  EXPECT_THAT(steps_of(measure({}, ids_[8])), ElementsAre(ids_[4], ids_[5], ids_[6], ids_[7]))
      << "a loop that closes now asks the newest";
  EXPECT_THAT(steps_of(measure({}, ids_[8])), ElementsAre(ids_[0], ids_[1], ids_[2], ids_[3]));
}

TEST_F(Odometry, GoesByTheTrackedLinkWhereTooLittleWasSeen) {
  go(2);
  Keyframe blind = test::keyframe_seeing(model_.camera, at(9), test::point_grid(3, 3, 9.0));
  blind.tracked_link = TrackedLink{ids_[1], standing_at(0.4), 1e4 * Matrix6d::Identity()};
  ids_.push_back(test::add_keyframe(map_, blind));
  const OdometryStep step = measured(2);
  EXPECT_EQ(step.before, ids_[1]);
  EXPECT_NEAR(step.before_from_camera.translation().x(), 0.4, 1e-12);
  EXPECT_GT(step.covariance(0, 0), std::pow(0.04, 2)) << "surfaces slide along themselves";
  EXPECT_LT(step.covariance(0, 0), std::pow(0.06, 2));

  blind.tracked_link->to = ids_[0];  // not the one before: nothing says where this one is from there
  ids_.push_back(test::add_keyframe(map_, blind));
  EXPECT_FALSE(measured(3).before.valid());
}

}  // namespace
}  // namespace vsgraphs
