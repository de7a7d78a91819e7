#include "core/solve/window_markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/map/test_map.h"
#include "core/solve/factors/marker_pose.h"
#include "core/solve/factors/pose_prior.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr MarkerId first{4}, second{9};

// Keyframes in a row that look along z; two markers ahead, seen exactly by all of them.
class WindowMarkers : public ::testing::Test {
 protected:
  WindowMarkers() {
    map.apply(AddMarker{second, {0.2, hanging_at(0.8, 0, 3), {}}});
    map.apply(AddMarker{first, {0.16, hanging_at(0.2, -0.3, 2), {}}});
    for (int k = 0; k < 5; ++k) {
      keyframes.push_back(add_keyframe(map, keyframe_seeing(model.camera, standing_at(0.2 * k), {})));
      for (const MarkerId id : {first, second}) see(keyframes.back(), id);
    }
  }
  static Se3 hanging_at(double x, double y, double z) {
    const Eigen::AngleAxisd half_turn(std::numbers::pi, Eigen::Vector3d::UnitX());
    return {half_turn.toRotationMatrix(), {x, y, z}};
  }
  void see(KeyframeId keyframe, MarkerId id) {
    const Se3& pose = map.keyframes().find(keyframe)->world_from_camera;
    const Matrix6d covariance = 1e-6 * Matrix6d::Identity();
    map.apply(AddMarkerObservation{
        id, {keyframe, pose.inverse() * map.markers().at(id)->world_from_marker, covariance}});
  }
  static Window window_of(std::vector<KeyframeId> free, std::vector<KeyframeId> fixed) {
    Window window;
    window.free = std::move(free);
    window.fixed = std::move(fixed);
    return window;
  }
  WindowProblem problem_of(std::vector<KeyframeId> free, std::vector<KeyframeId> fixed) const {
    return build_problem(map, window_of(std::move(free), std::move(fixed)), model);
  }
  template <typename Factor>
  static std::ptrdiff_t count(const WindowProblem& problem) {
    const auto& factors = problem.bundle.factors;
    return std::count_if(factors.begin(), factors.end(), [](const auto& factor) {
      return dynamic_cast<const Factor*>(factor.get()) != nullptr;
    });
  }
  static double error_m(const Se3& pose, double x) {
    return (pose.translation() - Eigen::Vector3d(x, 0, 0)).norm();
  }

  MeasurementModel model;
  Map map;
  std::vector<KeyframeId> keyframes;
};

TEST_F(WindowMarkers, SeenMarkersAreVariablesWithASightPerKeyframeAndAPriorPerKeyframeOutside) {
  const WindowProblem problem = problem_of({keyframes[4], keyframes[3]}, {keyframes[2]});
  EXPECT_THAT(problem.marker_of_variable, ElementsAre(first, second));
  EXPECT_EQ(count<MarkerPose>(problem), 2 * 3);
  EXPECT_EQ(count<PosePrior>(problem), 2 * 2);
  EXPECT_EQ(problem.bundle.factors.size(), 10U);
}

TEST_F(WindowMarkers, TheTruthCostsNothing) {
  WindowProblem problem = problem_of({keyframes[4], keyframes[3]}, {keyframes[2]});
  EXPECT_LT(solve_bundle(problem.bundle).initial_cost, 1e-9);
}

TEST_F(WindowMarkers, WhatNoFreeKeyframeOrOneAloneSeesIsNotInTheWindow) {
  map.apply(RemoveMarkerObservations{first, keyframes[4]});
  for (std::size_t k = 0; k < 4; ++k) map.apply(RemoveMarkerObservations{second, keyframes[k]});
  EXPECT_THAT(problem_of({keyframes[4]}, {keyframes[3]}).bundle.factors, IsEmpty());
}

TEST_F(WindowMarkers, ADriftedPoseComesBackByItsMarkersAlone) {
  Vector6d drift;
  drift << 0.05, -0.04, 0.06, 0.02, -0.03, 0.02;
  map.apply(MoveKeyframe{keyframes[4], standing_at(0.8).retract(drift)});
  const Window window = window_of({keyframes[4]}, {keyframes[3], keyframes[2]});
  WindowProblem problem = build_problem(map, window, model);
  const SolveReport report = solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  Draft draft(map.snapshot());
  apply_solution(window, problem, report, draft);
  const Map& solved = draft.map();
  EXPECT_LT(error_m(solved.keyframes().find(keyframes[4])->world_from_camera, 0.8), 1e-3);
  const Se3 off = hanging_at(0.2, -0.3, 2).inverse() * solved.markers().at(first)->world_from_marker;
  EXPECT_LT(off.log().norm(), 1e-3);
}

TEST_F(WindowMarkers, PriorsOfKeyframesOutsideHoldTheWindow) {
  map.apply(MoveKeyframe{keyframes[4], standing_at(0.9, 0.05)});
  WindowProblem problem = problem_of({keyframes[4]}, {});
  solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  EXPECT_LT(error_m(problem.bundle.poses[0], 0.8), 5e-3);
}

TEST_F(WindowMarkers, ManyKeyframesOutsideWeighLikeOne) {
  const auto information = [this] {  // of the first marker's priors along x
    WindowProblem problem = problem_of({keyframes[4]}, {});
    double sum = 0;
    for (const auto& factor : problem.bundle.factors) {
      if (!dynamic_cast<const PosePrior*>(factor.get()) || factor->variables()[0].index != 0) continue;
      FactorRows rows;
      factor->resize(rows);
      EXPECT_TRUE(factor->evaluate({problem.bundle.poses, problem.bundle.structures}, true, rows));
      sum += rows.jacobians[0].col(0).squaredNorm();
    }
    return sum;
  };
  const double of_four = information();
  for (std::size_t k = 1; k < 4; ++k) map.apply(RemoveMarkerObservations{first, keyframes[k]});
  EXPECT_GT(of_four, 0);
  EXPECT_NEAR(information() / of_four, 1, 0.2) << "they see it from other sides";
}

TEST_F(WindowMarkers, ARetiredKeyframesShareHangsOnItsAnchor) {
  map.apply(RemoveKeyframe{keyframes[3], keyframes[4]});
  map.apply(MoveKeyframe{keyframes[4], standing_at(0.9, 0.05)});
  WindowProblem problem = problem_of({keyframes[4]}, {keyframes[2]});
  EXPECT_EQ(count<MarkerPose>(problem), 2 * 3);
  solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  EXPECT_LT(error_m(problem.bundle.poses[0], 0.8), 5e-3);
}

TEST_F(WindowMarkers, AMarkerInTwoPlacesHoldsNothing) {
  map.apply(MoveMarker{first, hanging_at(5, 0, 2)});
  see(keyframes[0], first);
  EXPECT_THAT(problem_of({keyframes[4]}, {keyframes[3]}).marker_of_variable, ElementsAre(first, second))
      << "one stray reading";
  see(keyframes[1], first);
  EXPECT_THAT(problem_of({keyframes[4]}, {keyframes[3]}).marker_of_variable, ElementsAre(second));
}

TEST_F(WindowMarkers, AStrayReadingIsNoFactor) {
  map.apply(MoveMarker{first, hanging_at(5, 0, 2)});
  see(keyframes[4], first);
  map.apply(MoveMarker{first, hanging_at(0.2, -0.3, 2)});
  EXPECT_EQ(count<MarkerPose>(problem_of({keyframes[4]}, {keyframes[3]})), 2 * 2);
}

TEST_F(WindowMarkers, AMarkerThatIsNoVariableMovesWithItsFirstKeyframe) {
  for (std::size_t k = 0; k < 4; ++k) map.apply(RemoveMarkerObservations{second, keyframes[k]});
  const Window window = window_of({keyframes[4]}, {keyframes[3]});
  WindowProblem problem = build_problem(map, window, model);
  problem.bundle.poses[0] = standing_at(0.7);
  Draft draft(map.snapshot());
  apply_solution(window, problem, SolveReport{}, draft);
  const Se3& moved = draft.map().markers().at(second)->world_from_marker;
  EXPECT_LT((moved.translation() - Eigen::Vector3d(0.7, 0, 3)).norm(), 1e-12);
}

}  // namespace
}  // namespace vsgraphs
