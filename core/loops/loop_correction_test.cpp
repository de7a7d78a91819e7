#include "core/loops/loop_correction.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/loops/test_loop_world.h"

namespace vsgraphs {
namespace {

using test::standing_at;

// Patch `index` of a keyframe as a mapped plane, seen from where the keyframe is in the map.
PlaneId map_plane(Map& map, const std::vector<PlaneObservation>& observations) {
  const Se3& pose = map.keyframes().find(observations[0].keyframe)->world_from_camera;
  MappedPlane plane;
  plane.plane = map.patch(observations[0])->plane.transformed(pose);
  const PlaneId id = map.planes().next_id();
  map.apply(AddPlane{id, plane});
  for (const PlaneObservation& o : observations) map.apply(AddPlaneObservation{id, o});
  return id;
}

class LoopCorrectionTest : public ::testing::Test {
 protected:
  LoopCorrectionTest() : world_(options()), map_(world_.map) {}
  static test::LoopWorldOptions options() {
    test::LoopWorldOptions o;
    o.keyframes = 32;
    o.grids = false;
    o.drift_per_step << 0.003, 0.002, 0.003, 0, 0.001, 0;
    return o;
  }
  KeyframeId at(int k) const { return world_.ids[static_cast<std::size_t>(k)]; }
  // Keyframe 31 stands where keyframe 1 stood a turn earlier.
  LoopAlignment loop() const {
    return {at(31), map_.keyframes().find(at(1))->world_from_camera, 1e8 * Matrix6d::Identity(), {}};
  }
  Corrections corrections() const {
    SolveReport report;
    return spread_correction(map_, graph_of(map_, {}), loop(), at(1), {}, report);
  }

  test::LoopWorld world_;
  Map& map_;
};

TEST_F(LoopCorrectionTest, SpreadsTheCorrectionOverTheTurn) {
  const Corrections c = corrections();
  EXPECT_EQ(c[at(0).index].log().norm(), 0);
  double last = 0;
  for (const int k : {5, 15, 25, 31}) {
    const double moved = c[at(k).index].log().norm();
    EXPECT_GT(moved, last);
    last = moved;
  }
  EXPECT_GT(last, 0.05);
}

TEST_F(LoopCorrectionTest, LandmarksAndPlanesMoveWithTheirKeyframes) {
  const PlaneId plane = map_plane(map_, {{at(20), 0}});
  const Map before = map_;
  const Corrections c = corrections();
  Draft draft(map_.snapshot());
  move_map(c, draft);
  map_.apply(draft.take());
  const Se3 was = before.keyframes().find(at(20))->world_from_camera;
  const Se3 is = map_.keyframes().find(at(20))->world_from_camera;
  EXPECT_GT((was.inverse() * is).log().norm(), 0.03);
  map_.landmarks().for_each([&](LandmarkId id, const Landmark& landmark) {
    const KeyframeId first = landmark.observations.front().keyframe;
    const Eigen::Vector3d in_camera = before.keyframes().find(first)->world_from_camera.inverse() *
                                      before.landmarks().find(id)->point_in_world;
    const Eigen::Vector3d now =
        map_.keyframes().find(first)->world_from_camera.inverse() * landmark.point_in_world;
    EXPECT_LT((in_camera - now).norm(), 1e-9);
  });
  const AnchoredPlane expected = before.planes().find(plane)->plane.transformed(is * was.inverse());
  EXPECT_LT((map_.planes().find(plane)->plane.normal - expected.normal).norm(), 1e-9);
  EXPECT_NEAR(map_.planes().find(plane)->plane.d(), expected.d(), 1e-9);
}

TEST_F(LoopCorrectionTest, LandmarksAreLookedForFromWhereTheirKeyframesStandNow) {
  Corrections c(map_.keyframes().index_bound(), Se3(so3_exp({0, std::numbers::pi / 2, 0}), {1, 0, 0}));
  const Map before = map_;
  Draft draft(map_.snapshot());
  move_map(c, draft);
  before.landmarks().for_each([&](LandmarkId id, const Landmark& was) {
    const Eigen::Vector3f expected = c[0].rotation().cast<float>() * was.appearance.view_direction;
    EXPECT_LT((draft.map().landmarks().find(id)->appearance.view_direction - expected).norm(), 1e-5F);
  });
}

TEST_F(LoopCorrectionTest, MarkersMoveWithTheFirstKeyframeThatSawThemOrItsAnchor) {
  const Se3 seen = standing_at(0, 0, 2);
  const Se3 placed = map_.keyframes().find(at(20))->world_from_camera * seen;
  for (const std::uint32_t number : {1U, 2U}) map_.apply(AddMarker{{number}, {0.16, placed, {}}});
  map_.apply(AddMarkerObservation{{1}, {at(20), seen}});
  map_.apply(AddMarkerObservation{{2}, {at(21), seen}});
  map_.apply(RemoveKeyframe{at(21), at(22)});
  const Corrections c = corrections();
  Draft draft(map_.snapshot());
  move_map(c, draft);
  const auto moved = [&](std::uint32_t number) {
    return draft.map().markers().at({number})->world_from_marker;
  };
  EXPECT_LT(((c[at(20).index] * placed).matrix() - moved(1).matrix()).norm(), 1e-9);
  EXPECT_LT(((c[at(22).index] * placed).matrix() - moved(2).matrix()).norm(), 1e-9);
  EXPECT_GT((placed.matrix() - moved(1).matrix()).norm(), 1e-3);
}

TEST_F(LoopCorrectionTest, SightsBecomeOneWithWhatTheKeyframeHad) {
  const std::vector<LandmarkId> here = map_.keyframes().find(at(31))->landmarks;
  const LandmarkId there = map_.keyframes().find(at(1))->landmarks[7];
  LoopAlignment sighted = loop();
  sighted.sights = {{3, there}};
  const std::size_t observers = map_.landmarks().find(there)->observations.size();
  const std::size_t ours = map_.landmarks().find(here[3])->observations.size();
  Draft draft(map_.snapshot());
  join_sights(sighted, draft);
  map_.apply(draft.take());
  EXPECT_EQ(map_.landmarks().resolve(here[3]), there);
  EXPECT_EQ(map_.landmarks().find(there)->observations.size(), observers + ours);

  // A feature without a landmark gets one.
  map_.apply(RemoveObservation{map_.keyframes().find(at(31))->landmarks[9], at(31)});
  const LandmarkId other = map_.keyframes().find(at(1))->landmarks[8];
  sighted.sights = {{9, other}};
  Draft second(map_.snapshot());
  join_sights(sighted, second);
  map_.apply(second.take());
  EXPECT_EQ(map_.keyframes().find(at(31))->landmarks[9], other);
}

class PlaneMerging : public ::testing::Test {
 protected:
  static test::LoopWorldOptions options() {
    test::LoopWorldOptions o;
    o.keyframes = 32;
    o.grids = false;
    return o;
  }
  void merge() {
    Draft draft(world_.map.snapshot());
    merge_coinciding_planes({world_.ids[31]}, {world_.ids[1]}, {}, draft);
    world_.map.apply(draft.take());
  }
  test::LoopWorld world_{options()};
};

TEST_F(PlaneMerging, JoinsTwoSightsOfOneWallAndKeepsTheOlder) {
  const PlaneId older = map_plane(world_.map, {{world_.ids[1], 0}});
  const PlaneId younger = map_plane(world_.map, {{world_.ids[31], 0}});
  merge();
  EXPECT_EQ(world_.map.planes().resolve(younger), older);
  EXPECT_EQ(world_.map.planes().find(older)->observations.size(), 2U);
}

TEST_F(PlaneMerging, LeavesOtherWallsAlone) {
  map_plane(world_.map, {{world_.ids[1], 0}});
  const PlaneId moved = map_plane(world_.map, {{world_.ids[31], 0}});
  AnchoredPlane plane = world_.map.planes().find(moved)->plane;
  plane.offset_m += 0.2;
  world_.map.apply(MovePlane{moved, plane});
  const PlaneId turned = map_plane(world_.map, {{world_.ids[31], 0}});
  plane.offset_m -= 0.2;
  plane.normal = -plane.normal;
  world_.map.apply(MovePlane{turned, plane});
  merge();
  EXPECT_EQ(world_.map.planes().size(), 3U);
}

}  // namespace
}  // namespace vsgraphs
