#include "core/solve/window_planes.h"

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

// Keyframes in a row at y = 0 that look along z; a wall ahead, one at the side and the ground (y points down).
class WindowPlanes : public ::testing::Test {
 protected:
  WindowPlanes() {
    for (const AnchoredPlane& truth : truths) {
      MappedPlane plane;
      plane.plane = truth;
      planes.push_back(map.planes().next_id());
      map.apply(AddPlane{planes.back(), plane});
    }
    for (int k = 0; k < 5; ++k) add(0.2 * k);
    map.apply(vsgraphs::SetUp{{0, -1, 0}});
  }
  // At the true pose, with an exact patch of each plane, anchored 2 m or so ahead.
  KeyframeId add(double x) {
    const Se3 pose = standing_at(x);
    Keyframe keyframe = keyframe_seeing(model.camera, pose, {});
    const KeyframeId id = add_keyframe(map, keyframe);
    auto surfaces = std::make_shared<KeyframeSurfaces>();
    for (const AnchoredPlane& truth : truths) {
      SurfacePatch patch;
      patch.plane =
          truth.anchored_at(truth.project(pose * Eigen::Vector3d(0, 0, 2))).transformed(pose.inverse());
      patch.information = Eigen::Vector3d(1e5, 1e5, 1e5).asDiagonal();
      surfaces->patches.push_back(patch);
    }
    map.apply(SetPatches{id, surfaces});
    for (std::size_t i = 0; i < planes.size(); ++i)
      map.apply(AddPlaneObservation{planes[i], {id, static_cast<std::uint16_t>(i)}});
    keyframes.push_back(id);
    return id;
  }
  void classify(std::size_t i, SurfaceRole role) { map.apply(ClassifyPlane{planes[i], role, {}}); }
  WindowProblem problem_of(std::vector<KeyframeId> free, std::vector<KeyframeId> fixed) const {
    Window window;
    window.free = std::move(free);
    window.fixed = std::move(fixed);
    return build_problem(map, window, model);
  }
  std::size_t factors(std::vector<KeyframeId> free, std::vector<KeyframeId> fixed) const {
    return problem_of(std::move(free), std::move(fixed)).bundle.factors.size();
  }
  static double error_m(const Se3& pose, double x) {
    return (pose.translation() - Eigen::Vector3d(x, 0, 0)).norm();
  }

  const std::vector<AnchoredPlane> truths = {{-Eigen::Vector3d::UnitZ(), {0, 0, 3}, 0},
                                             {-Eigen::Vector3d::UnitX(), {2, 0, 2}, 0},
                                             {-Eigen::Vector3d::UnitY(), {0, 1.4, 2}, 0}};
  MeasurementModel model;
  Map map;
  std::vector<PlaneId> planes;
  std::vector<KeyframeId> keyframes;
};

TEST_F(WindowPlanes, PlanesOfFreeKeyframesAreVariablesWithOneObservationEachAndOnePrior) {
  const WindowProblem problem = problem_of({keyframes[4], keyframes[3]}, {keyframes[2]});
  EXPECT_THAT(problem.plane_of_variable, ElementsAre(planes[0], planes[1], planes[2]));
  EXPECT_THAT(problem.bundle.factors, SizeIs(3 * (2 + 1)));
}

TEST_F(WindowPlanes, WhatNoFreeKeyframeSeesIsNotInTheWindow) {
  map.apply(RemovePlaneObservation{planes[1], {keyframes[4], 1}});
  EXPECT_THAT(problem_of({keyframes[4]}, {keyframes[3]}).plane_of_variable, Not(Contains(planes[1])));
}

TEST_F(WindowPlanes, WhatOneKeyframeAloneHasSeenHoldsNothing) {
  for (std::size_t k = 0; k < 4; ++k) map.apply(RemovePlaneObservation{planes[1], {keyframes[k], 1}});
  EXPECT_THAT(problem_of({keyframes[4]}, {keyframes[3]}).plane_of_variable, Not(Contains(planes[1])));
  // Nor do two pieces of one keyframe.
  map.apply(AddPlaneObservation{planes[1], {keyframes[4], 0}});
  EXPECT_THAT(problem_of({keyframes[4]}, {keyframes[3]}).plane_of_variable, Not(Contains(planes[1])));
}

TEST_F(WindowPlanes, TheTruthCostsNothing) {
  WindowProblem problem = problem_of({keyframes[4], keyframes[3]}, {keyframes[2]});
  EXPECT_LT(solve_bundle(problem.bundle).initial_cost, 1e-9);
}

TEST_F(WindowPlanes, ADriftedPoseComesBackByItsPlanesAlone) {
  Vector6d drift;
  drift << 0.05, -0.04, 0.06, 0.02, -0.03, 0.02;
  map.apply(MoveKeyframe{keyframes[4], standing_at(0.8).retract(drift)});
  WindowProblem problem = problem_of({keyframes[4]}, {keyframes[3]});
  solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  EXPECT_LT(error_m(problem.bundle.poses[0], 0.8), 1e-3);
  EXPECT_LT(rotation_angle(problem.bundle.poses[0].rotation()), 1e-3);
  // Without planes nothing holds it.
  Map bare = map;
  for (const PlaneId id : planes) bare.apply(RemovePlane{id});
  Window window;
  window.free = {keyframes[4]};
  window.fixed = {keyframes[3]};
  EXPECT_THAT(build_problem(bare, window, model).bundle.factors, IsEmpty());
}

TEST_F(WindowPlanes, PriorsOfKeyframesOutsideHoldTheWindowToo) {
  map.apply(MoveKeyframe{keyframes[4], standing_at(0.9, 0.05)});
  WindowProblem problem = problem_of({keyframes[4]}, {});
  solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  EXPECT_LT(error_m(problem.bundle.poses[0], 0.8), 5e-3);
}

TEST_F(WindowPlanes, ARetiredKeyframesShareHangsOnItsAnchor) {
  map.apply(RemoveKeyframe{keyframes[3], keyframes[4]});
  // It is an observation of the free keyframe now, and moves with it.
  EXPECT_EQ(factors({keyframes[4]}, {keyframes[2]}), 3U * (2 + 1));
  map.apply(MoveKeyframe{keyframes[4], standing_at(0.9, 0.05)});
  WindowProblem problem = problem_of({keyframes[4]}, {keyframes[2]});
  solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  EXPECT_LT(error_m(problem.bundle.poses[0], 0.8), 5e-3);
}

TEST_F(WindowPlanes, WallsStandOnTheGroundOnceBothAreKnownAsSuch) {
  const std::size_t before = factors({keyframes[4]}, {keyframes[3]});
  classify(0, SurfaceRole::wall);
  classify(1, SurfaceRole::wall);
  EXPECT_EQ(factors({keyframes[4]}, {keyframes[3]}), before) << "no ground to stand on";
  classify(2, SurfaceRole::ground);
  EXPECT_EQ(factors({keyframes[4]}, {keyframes[3]}), before + 2);
  classify(1, SurfaceRole::door);
  EXPECT_EQ(factors({keyframes[4]}, {keyframes[3]}), before + 1);
}

TEST_F(WindowPlanes, AWallThatLeansIsNotBentUpright) {
  classify(0, SurfaceRole::wall);
  classify(2, SurfaceRole::ground);
  const std::size_t upright = factors({keyframes[4]}, {keyframes[3]});
  AnchoredPlane leaning = truths[0];
  leaning.normal = Eigen::Vector3d(0, 0.3, -1).normalized();
  map.apply(MovePlane{planes[0], leaning});
  EXPECT_EQ(factors({keyframes[4]}, {keyframes[3]}), upright - 1);
}

TEST_F(WindowPlanes, TheSolutionMovesPlanesInTheMap) {
  AnchoredPlane off = truths[0];
  off.offset_m += 0.03;
  map.apply(MovePlane{planes[0], off});
  Window window;
  window.free = {keyframes[4]};
  window.fixed = {keyframes[3], keyframes[2]};
  WindowProblem problem = build_problem(map, window, model);
  const SolveReport report = solve_bundle(problem.bundle, BundleOptions{.max_iterations = 30});
  Draft draft(map.snapshot());
  apply_solution(window, problem, report, draft);
  EXPECT_NEAR(draft.map().planes().find(planes[0])->plane.signed_distance({0, 0, 3}), 0, 2e-3);
}

TEST_F(WindowPlanes, APlaneThatOneKeyframeAloneHasSeenMovesWithIt) {
  for (std::size_t k = 0; k < 4; ++k) map.apply(RemovePlaneObservation{planes[1], {keyframes[k], 1}});
  // The keyframe and what it alone has seen stand 0.1 m too far right.
  map.apply(MoveKeyframe{keyframes[4], standing_at(0.9)});
  AnchoredPlane off = truths[1];
  off.anchor.x() += 0.1;
  map.apply(MovePlane{planes[1], off});
  map.apply(AddPlane{map.planes().next_id(), MappedPlane{}});
  WindowProblem problem = problem_of({keyframes[4]}, {keyframes[3]});
  problem.bundle.poses[0] = standing_at(0.8);
  Window window;
  window.free = {keyframes[4]};
  window.fixed = {keyframes[3]};
  Draft draft(map.snapshot());
  SolveReport report;
  apply_solution(window, problem, report, draft);
  EXPECT_NEAR(draft.map().planes().find(planes[1])->plane.signed_distance({2, 0, 2}), 0, 1e-9);
}

}  // namespace
}  // namespace vsgraphs
