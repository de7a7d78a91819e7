#include "core/solve/window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class WindowTest : public ::testing::Test {
 protected:
  KeyframeId add(const Se3& pose, const Points& points) {
    return add_keyframe(map_, keyframe_seeing(model_.camera, pose, points));
  }
  // Makes the first `count` points landmarks seen by both keyframes, or adds the second to those there are.
  void share(KeyframeId a, KeyframeId b, int count) {
    for (int i = 0; i < count; ++i) {
      const auto feature = static_cast<std::uint16_t>(i);
      const LandmarkId present = map_.keyframes().find(a)->landmarks[feature];
      if (present.valid()) {
        map_.apply(AddObservation{present, {b, feature}});
      } else {
        add_landmark(map_, points_[feature], i, {{a, feature}, {b, feature}});
      }
    }
  }
  const Keyframe& keyframe(KeyframeId id) const { return *map_.keyframes().find(id); }

  MeasurementModel model_;
  Points points_ = point_grid(6, 5);
  Map map_;
};

// Centre (the newest) shares 30 landmarks with a, 20 with b and 14 with c.
class FourKeyframes : public WindowTest {
 protected:
  FourKeyframes() {
    c = add(standing_at(0.3), points_);
    b = add(standing_at(0.2), points_);
    a = add(standing_at(0.1), points_);
    centre = add(standing_at(0), points_);
    share(centre, a, 30);
    share(centre, b, 20);
    share(centre, c, 14);
  }
  KeyframeId a, b, c, centre;
};

TEST_F(FourKeyframes, MostSharedAreFreeAndThinlySharedAreWitnesses) {
  const Window window = select_window(map_, centre, 10, 10);
  EXPECT_THAT(window.free, ElementsAre(centre, a, b));
  EXPECT_THAT(window.fixed, ElementsAre(c));
  EXPECT_THAT(window.landmarks, SizeIs(30));
  EXPECT_THAT(window.passengers, IsEmpty());
}

TEST_F(FourKeyframes, WhatDoesNotFitIsAWitnessTheMostCloselyTiedFirst) {
  EXPECT_THAT(select_window(map_, centre, 2, 10).free, ElementsAre(centre, a));
  EXPECT_THAT(select_window(map_, centre, 2, 10).fixed, ElementsAre(b, c));
  EXPECT_THAT(select_window(map_, centre, 2, 1).fixed, ElementsAre(b));
}

TEST_F(FourKeyframes, WithoutWitnessTheOldestIsFixed) {
  share(centre, c, 20);  // now c belongs to the window too
  const Window window = select_window(map_, centre, 10, 10);
  EXPECT_THAT(window.free, ElementsAre(centre, a, b));
  EXPECT_THAT(window.fixed, ElementsAre(c));
  // Even where the oldest is the one in the middle.
  const Window around_oldest = select_window(map_, c, 10, 10);
  EXPECT_THAT(around_oldest.fixed, ElementsAre(c));
  EXPECT_THAT(around_oldest.free, Not(Contains(c)));
}

TEST_F(FourKeyframes, ALandmarkThatOneKeyframeSeesIsAPassenger) {
  const Points more = point_grid(7, 5);
  const KeyframeId newest = add(standing_at(0.05), more);
  for (int i = 0; i < 30; ++i) {
    map_.apply(AddObservation{keyframe(centre).landmarks[static_cast<std::size_t>(i)],
                              {newest, static_cast<std::uint16_t>(i)}});
  }
  const LandmarkId alone = add_landmark(map_, more[34], 34, {{newest, 34}});
  const Window window = select_window(map_, newest, 10, 10);
  EXPECT_THAT(window.passengers, ElementsAre(alone));
  EXPECT_THAT(window.landmarks, Not(Contains(alone)));
  EXPECT_THAT(window.landmarks, SizeIs(30));
}

TEST_F(FourKeyframes, ProblemAtTheTruthHasNoCost) {
  const Window window = select_window(map_, centre, 10, 10);
  WindowProblem problem = build_problem(map_, window, model_);
  EXPECT_THAT(problem.keyframe_of_pose, ElementsAre(centre, a, b, c));
  EXPECT_THAT(problem.bundle.pose_fixed, ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(problem.landmark_of_point, window.landmarks);
  EXPECT_THAT(problem.bundle.observations, SizeIs(30 + 30 + 20 + 14));
  EXPECT_LT(solve_bundle(problem.bundle).initial_cost, 1e-4);
}

TEST_F(WindowTest, MeasurementsAreWeightedByLevelAndDepth) {
  Keyframe coarse = with_features_changed(keyframe_seeing(model_.camera, standing_at(0.1), points_),
                                          model_.camera, [](std::vector<Feature>& features) {
                                            for (Feature& f : features) f.level = 3;
                                            features[1].depth_m = 0;
                                          });
  const KeyframeId a = add(standing_at(0), points_), b = add_keyframe(map_, coarse);
  share(a, b, 30);
  const WindowProblem problem = build_problem(map_, select_window(map_, b, 10, 10), model_);
  int coarse_seen = 0, without_depth = 0;
  for (const ReprojectionObservation& o : problem.bundle.observations) {
    const bool of_b = problem.keyframe_of_pose[static_cast<std::size_t>(o.pose)] == b;
    coarse_seen += of_b;
    without_depth += !o.has_depth();
    EXPECT_NEAR(o.inv_sigma_px, of_b ? 1.0 / std::pow(1.2, 3) : 1.0, 1e-6);
    if (!o.has_depth()) continue;
    const double depth_m = 1.0 / static_cast<double>(o.inverse_depth);
    EXPECT_NEAR(o.inv_sigma_inverse_depth, inv_sigma_of_inverse_depth(model_.camera.depth_noise, depth_m),
                1e-3 * static_cast<double>(o.inv_sigma_inverse_depth));
  }
  EXPECT_EQ(coarse_seen, 30);
  EXPECT_EQ(without_depth, 1);
}

// Two groups of keyframes without a common landmark; a link chains them.
class LinkedKeyframes : public ::testing::Test {
 protected:
  LinkedKeyframes() {
    old_ = add_keyframe(map_, keyframe_seeing(model_.camera, standing_at(0), here_));
    middle_ = add_keyframe(map_, keyframe_seeing(model_.camera, standing_at(0.1), here_));
    add_landmarks(map_, here_, {old_, middle_});
    new_ = add_linked(standing_at(5), middle_, standing_at(4.9));
  }
  KeyframeId add_linked(const Se3& pose, KeyframeId to, const Se3& to_from_camera) {
    Keyframe keyframe = keyframe_seeing(model_.camera, pose, point_grid(6, 5, 5.0));
    keyframe.tracked_link = TrackedLink{to, to_from_camera, 1e6 * Matrix6d::Identity()};
    return add_keyframe(map_, keyframe);
  }
  MeasurementModel model_;
  Points here_ = point_grid(6, 5);
  Map map_;
  KeyframeId old_, middle_, new_;
};

TEST_F(LinkedKeyframes, TheOtherEndOfALinkBelongsToTheWindow) {
  const Window window = select_window(map_, new_, 10, 10);
  EXPECT_THAT(window.free, ElementsAre(new_, middle_));
  EXPECT_THAT(window.fixed, ElementsAre(old_));
}

TEST_F(LinkedKeyframes, LinksAreFollowedFromLinkToLinkAsFarAsThereIsRoom) {
  const KeyframeId next = add_linked(standing_at(5.1), new_, standing_at(0.1));
  EXPECT_THAT(select_window(map_, next, 10, 10).free, ElementsAre(next, new_, middle_));
  EXPECT_THAT(select_window(map_, next, 2, 10).fixed, ElementsAre(new_));  // no witness: the older of the two
  EXPECT_THAT(select_window(map_, next, 2, 10).free, ElementsAre(next));
}

TEST_F(LinkedKeyframes, ALinkHoldsAKeyframeThatSharesNoLandmark) {
  map_.apply(MoveKeyframe{new_, standing_at(5.2, 0.1)});
  const Window window = select_window(map_, new_, 10, 10);
  WindowProblem problem = build_problem(map_, window, model_);
  ASSERT_THAT(problem.bundle.factors, SizeIs(1));
  const SolveReport report = solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  Draft draft(map_.snapshot());
  apply_solution(window, problem, report, draft);
  const Eigen::Vector3d at = draft.map().keyframes().find(new_)->world_from_camera.translation();
  EXPECT_LT((at - Eigen::Vector3d(5, 0, 0)).norm(), 1e-4);
}

TEST_F(LinkedKeyframes, ALinkToARemovedKeyframeGoesToItsAnchor) {
  map_.apply(RemoveKeyframe{middle_, old_});
  map_.apply(MoveKeyframe{new_, standing_at(5.2, 0.1)});
  const Window window = select_window(map_, new_, 10, 10);
  EXPECT_THAT(window.fixed, ElementsAre(old_));
  WindowProblem problem = build_problem(map_, window, model_);
  ASSERT_THAT(problem.bundle.factors, SizeIs(1));
  solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  // 4.9 m from the removed one, which stood 0.1 m from its anchor.
  EXPECT_LT((problem.bundle.poses[0].translation() - Eigen::Vector3d(5, 0, 0)).norm(), 1e-4);
}

TEST_F(LinkedKeyframes, ALinkBetweenFixedKeyframesIsNoFactor) {
  Window window;
  window.free = {old_};
  window.fixed = {middle_, new_};
  EXPECT_THAT(build_problem(map_, window, model_).bundle.factors, IsEmpty());
  window.fixed = {middle_};
  window.free = {old_, new_};
  EXPECT_THAT(build_problem(map_, window, model_).bundle.factors, SizeIs(1));
}

// A window that starts wrong in poses and points, with one false observation and one passenger.
class WrongStart : public WindowTest {
 protected:
  WrongStart() {
    for (int k = 0; k < 3; ++k) witnesses.push_back(add(standing_at(0.1 * k), seen));
    const Keyframe false_at_7 = with_features_changed(keyframe_seeing(model_.camera, standing_at(0.3), seen),
                                                      model_.camera, [](auto& f) { f[7].u += 60; });
    moved = add_keyframe(map_, false_at_7);
    for (int i = 0; i < 35; ++i) {
      const auto feature = static_cast<std::uint16_t>(i);
      add_landmark(
          map_, seen[feature] + Eigen::Vector3d(0.01, -0.01, 0.02), i,
          {{witnesses[0], feature}, {witnesses[1], feature}, {witnesses[2], feature}, {moved, feature}});
    }
    passenger = add_landmark(map_, seen[35] + Eigen::Vector3d(0.05, 0, 0), 35, {{moved, 35}});
    map_.apply(MoveKeyframe{moved, standing_at(0.35)});
  }
  // The map after an adjustment of the newest keyframe alone.
  Map adjusted() {
    const Window window = select_window(map_, moved, 1, 10);
    WindowProblem problem = build_problem(map_, window, model_);
    const BundleOptions options{.max_iterations = 20, .iterations_before_dropping = 10};
    const SolveReport report = solve_bundle(problem.bundle, options);
    Draft draft(map_.snapshot());
    apply_solution(window, problem, report, draft);
    return draft.map();
  }

  const Points seen = point_grid(6, 6);
  std::vector<KeyframeId> witnesses;
  KeyframeId moved;
  LandmarkId passenger;
};

TEST_F(WrongStart, PosesAndPointsGoBackIntoTheMap) {
  const Map after = adjusted();
  const auto position = [&after](KeyframeId id) {
    return after.keyframes().find(id)->world_from_camera.translation();
  };
  EXPECT_LT((position(moved) - Eigen::Vector3d(0.3, 0, 0)).norm(), 1e-3);
  for (std::size_t k = 0; k < witnesses.size(); ++k) {
    EXPECT_EQ(position(witnesses[k]), keyframe(witnesses[k]).world_from_camera.translation());
  }
  for (std::size_t i = 0; i < 35; ++i) {
    const Landmark& landmark = *after.landmarks().find(keyframe(witnesses[0]).landmarks[i]);
    EXPECT_LT((landmark.point_in_world - seen[i]).norm(), 2e-3) << "landmark " << i;
  }
}

TEST_F(WrongStart, OnlyTheFalseObservationIsRemoved) {
  const Map after = adjusted();
  for (std::size_t i = 0; i < 35; ++i) {
    const LandmarkId id = keyframe(witnesses[0]).landmarks[i];
    EXPECT_THAT(after.landmarks().find(id)->observations, SizeIs(i == 7 ? 3 : 4)) << "landmark " << i;
    EXPECT_EQ(after.keyframes().find(moved)->landmarks[i].valid(), i != 7) << "landmark " << i;
  }
}

TEST_F(WrongStart, ALandmarkThatAllContradictVanishes) {
  // With one witness left there is no telling who is right.
  const LandmarkId doubtful = keyframe(moved).landmarks[7];
  map_.apply(RemoveObservation{doubtful, witnesses[0]});
  map_.apply(RemoveObservation{doubtful, witnesses[1]});
  const Map after = adjusted();
  EXPECT_FALSE(after.landmarks().contains(doubtful));
  EXPECT_FALSE(after.keyframes().find(moved)->landmarks[7].valid());
  EXPECT_FALSE(after.keyframes().find(witnesses[2])->landmarks[7].valid());
}

TEST_F(WrongStart, PassengersMoveWithTheirKeyframe) {
  // It stood 0.05 m off with its keyframe, which has gone back.
  EXPECT_LT((adjusted().landmarks().find(passenger)->point_in_world - seen[35]).norm(), 1e-3);
}

TEST_F(WrongStart, PassengersTurnWithTheirKeyframe) {
  map_.apply(MoveKeyframe{moved, {so3_exp({0, 0.05, 0}), {0.35, 0, 0}}});
  const Se3 before = keyframe(moved).world_from_camera;
  const Map after = adjusted();
  const Se3 turn = after.keyframes().find(moved)->world_from_camera * before.inverse();
  ASSERT_GT(rotation_angle(turn.rotation()), 0.04);
  const auto direction = [this](const Map& map) {
    return map.landmarks().find(passenger)->appearance.view_direction;
  };
  EXPECT_LT((direction(after) - turn.rotation().cast<float>() * direction(map_)).norm(), 1e-5F);
}

}  // namespace
}  // namespace vsgraphs
