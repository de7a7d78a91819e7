#include "core/loops/loop_rebase.h"

#include <gtest/gtest.h>

#include "core/base/check.h"
#include "core/loops/test_loop_world.h"
#include "core/map/carry.h"
#include "core/map/draft.h"

namespace vsgraphs {
namespace {

using test::LoopWorld;

Vector6d draw(Rng& rng, double scale) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = scale * rng.normal();
  return xi;
}

PlaneId add_plane(Map& map, const AnchoredPlane& plane, const std::vector<PlaneObservation>& observations) {
  const PlaneId id = map.planes().next_id();
  map.apply(AddPlane{id, MappedPlane{plane, SurfaceRole::wall, {}, {}, {}, 0}});
  for (const PlaneObservation& o : observations) map.apply(AddPlaneObservation{id, o});
  return id;
}

// Some keyframes of a turn, with a plane that three of them see.
class Rebase : public ::testing::TestWithParam<int> {
 protected:
  Rebase() : world_(options()), map_(world_.map), rng_(GetParam(), "rebase", 0) {
    const Keyframe& first = *map_.keyframes().find(world_.ids[0]);
    plane_ = add_plane(map_, first.patches->patches[0].plane.transformed(first.world_from_camera),
                       {{world_.ids[0], 0}, {world_.ids[1], 0}, {world_.ids[2], 0}});
    const Se3 seen(Eigen::Matrix3d::Identity(), {0.2, 0.1, 2});
    map_.apply(AddMarker{{3}, {0.16, first.world_from_camera * seen, {}}});
    map_.apply(AddMarkerObservation{{3}, {world_.ids[0], seen}});
    old_ = map_.snapshot();
  }
  static test::LoopWorldOptions options() {
    test::LoopWorldOptions o;
    o.keyframes = 8;
    o.grids = false;
    return o;
  }

  // Everything the old map holds moves by a rigid transform.
  MapEdit moves_all_by(const Se3& correction) const {
    Draft draft(old_);
    old_->keyframes().for_each([&](KeyframeId id, const Keyframe& k) {
      draft.record(MoveKeyframe{id, correction * k.world_from_camera});
    });
    old_->landmarks().for_each([&](LandmarkId id, const Landmark& l) {
      draft.record(MoveLandmark{id, correction * l.point_in_world});
    });
    old_->planes().for_each([&](PlaneId id, const MappedPlane& p) {
      draft.record(MovePlane{id, p.plane.transformed(correction)});
    });
    for (const auto& [id, marker] : old_->markers())
      draft.record(MoveMarker{id, correction * marker->world_from_marker});
    return draft.take();
  }

  // What local mapping does in the meantime.
  MapEdit refinement(double scale) {
    Draft draft(map_.snapshot());
    const Map before = draft.map();
    before.keyframes().for_each([&](KeyframeId id, const Keyframe& k) {
      draft.record(MoveKeyframe{id, k.world_from_camera.retract(draw(rng_, scale))});
    });
    before.landmarks().for_each([&](LandmarkId id, const Landmark& l) {
      draft.record(MoveLandmark{id, l.point_in_world + draw(rng_, scale).head<3>()});
    });
    before.planes().for_each([&](PlaneId id, const MappedPlane& p) {
      draft.record(MovePlane{id, p.plane.retract(draw(rng_, scale).head<3>())});
    });
    for (const auto& [id, marker] : before.markers())
      draft.record(MoveMarker{id, marker->world_from_marker.retract(draw(rng_, scale))});
    return draft.take();
  }

  void expect_moved_by(const Se3& correction, const Map& from, const Map& to) const {
    from.keyframes().for_each([&](KeyframeId id, const Keyframe& k) {
      const Se3 expected = correction * k.world_from_camera;
      EXPECT_LT((expected.matrix() - to.keyframes().find(id)->world_from_camera.matrix()).norm(), 1e-9);
    });
    from.landmarks().for_each([&](LandmarkId id, const Landmark& l) {
      EXPECT_LT((correction * l.point_in_world - to.landmarks().find(id)->point_in_world).norm(), 1e-9);
    });
    from.planes().for_each([&](PlaneId id, const MappedPlane& p) {
      const AnchoredPlane expected = p.plane.transformed(correction), &is = to.planes().find(id)->plane;
      EXPECT_LT((expected.normal - is.normal).norm(), 1e-9);
      EXPECT_NEAR(is.signed_distance(expected.project(expected.anchor)), 0, 1e-9);
    });
    for (const auto& [id, marker] : from.markers()) {
      const Se3 expected = correction * marker->world_from_marker;
      EXPECT_LT((expected.matrix() - to.markers().at(id)->world_from_marker.matrix()).norm(), 1e-9);
    }
  }

  LoopWorld world_;
  Map& map_;
  Rng rng_;
  PlaneId plane_;
  Snapshot old_;
};

TEST_P(Rebase, WithoutChangesTheEditStaysAsItIs) {
  const MapEdit edit = moves_all_by(Se3::exp(draw(rng_, 0.3)));
  EXPECT_EQ(rebase(edit, *old_, map_).hash(), edit.hash());
}

TEST_P(Rebase, ALandmarkTurnsTheLookItHasByThen) {
  const Se3 correction = Se3::exp(draw(rng_, 0.3));
  MapEdit edit;
  edit.based_on = old_->version();
  edit.operations = carry(*old_, Corrections(old_->keyframes().index_bound(), correction));
  const LandmarkId seen_anew = old_->keyframes().find(world_.ids[2])->landmarks[0];
  Appearance look = old_->landmarks().find(seen_anew)->appearance;
  look.view_direction = Eigen::Vector3f::UnitX();
  map_.apply(MapEdit{0, {SetAppearance{seen_anew, look}}});
  const Snapshot met = map_.snapshot();
  map_.apply(rebase(edit, *old_, *met));
  met->landmarks().for_each([&](LandmarkId id, const Landmark& was) {
    const Eigen::Vector3f expected = correction.rotation().cast<float>() * was.appearance.view_direction;
    EXPECT_LT((map_.landmarks().find(id)->appearance.view_direction - expected).norm(), 1e-5F);
  });
}

TEST_P(Rebase, WhatTheEditMovedStandsWhereItPutItWhateverHappenedSince) {
  const Se3 correction = Se3::exp(draw(rng_, 0.3));
  const MapEdit edit = moves_all_by(correction);
  map_.apply(refinement(0.02));
  map_.apply(rebase(edit, *old_, map_));
  expect_moved_by(correction, *old_, map_);
}

TEST_P(Rebase, FollowsWhatLoopsHaveMovedSince) {
  const Se3 correction = Se3::exp(draw(rng_, 0.3)), loop = Se3::exp(draw(rng_, 0.5));
  const MapEdit edit = moves_all_by(correction);
  const std::vector<Se3> moved(old_->keyframes().index_bound(), loop);
  map_.apply(MapEdit{0, carry(*old_, moved)});
  map_.apply(refinement(0.02));
  map_.apply(rebase(edit, *old_, map_, moved));
  expect_moved_by(loop * correction, *old_, map_);
}

TEST_P(Rebase, WhatWasMadeSinceIsCarriedAlong) {
  const Se3 correction = Se3::exp(draw(rng_, 0.3));
  const MapEdit edit = moves_all_by(correction);
  Keyframe late = *map_.keyframes().find(world_.ids.back());
  late.landmarks.clear();
  late.frame_index += 10;
  late.world_from_camera = late.world_from_camera.retract(draw(rng_, 0.1));
  late.tracked_link = TrackedLink{world_.ids.back(), Se3{}, Matrix6d::Identity()};
  const KeyframeId later = test::add_keyframe(map_, late);
  test::add_landmark(map_, {1, 2, 3}, 9999, {{later, 0}});
  add_plane(map_, AnchoredPlane{Eigen::Vector3d::UnitX(), {0.5, 0, 0}, 0.1}, {{later, 0}});
  map_.apply(AddMarker{{4}, {0.16, late.world_from_camera, {}}});
  map_.apply(AddMarkerObservation{{4}, {later, Se3{}}});
  map_.apply(MapEdit{});
  const Snapshot grown = map_.snapshot();
  map_.apply(rebase(edit, *old_, *grown));
  expect_moved_by(correction, *grown, map_);
}

TEST_P(Rebase, AKeyframeWithoutLinkHangsOnWhomItSharesMostWith) {
  Draft draft(old_);
  const Se3 correction = Se3::exp(draw(rng_, 0.3));
  const KeyframeId moved = world_.ids[3];
  draft.record(MoveKeyframe{moved, correction * old_->keyframes().find(moved)->world_from_camera});
  const MapEdit edit = draft.take();
  Keyframe late = *map_.keyframes().find(moved);
  const std::vector<LandmarkId> seen = late.landmarks;
  late.tracked_link.reset();
  const KeyframeId later = test::add_keyframe(map_, late);
  for (std::size_t i = 0; i < seen.size(); ++i)
    map_.apply(AddObservation{seen[i], {later, static_cast<std::uint16_t>(i)}});
  map_.apply(MapEdit{});
  const Se3 before = map_.keyframes().find(later)->world_from_camera;
  map_.apply(rebase(edit, *old_, map_));
  EXPECT_LT(
      (map_.keyframes().find(later)->world_from_camera.matrix() - (correction * before).matrix()).norm(),
      1e-9);
}

TEST_P(Rebase, WhatTheEditLeftAloneStaysAsItIs) {
  Draft draft(old_);
  const KeyframeId moved = world_.ids[3], left_alone = world_.ids[4];
  draft.record(MoveKeyframe{moved, Se3::exp(draw(rng_, 0.3))});
  const MapEdit edit = draft.take();
  map_.apply(refinement(0.02));
  const Se3 refined = map_.keyframes().find(left_alone)->world_from_camera;
  map_.apply(rebase(edit, *old_, map_));
  EXPECT_TRUE(map_.keyframes().find(left_alone)->world_from_camera.matrix() == refined.matrix());
}

TEST_P(Rebase, RoomsFoundAnewSinceStandWhereTheyWereFound) {
  const auto with_room_at = [](const Eigen::Vector3d& node) {
    auto structure = std::make_shared<FoundStructure>();
    structure->rooms.resize(1);
    structure->room_nodes = {node};
    return SetStructure{structure};
  };
  map_.apply(with_room_at({1, 1, 1}));
  map_.apply(MapEdit{});
  const Snapshot with_room = map_.snapshot();
  Draft draft(with_room);
  draft.record(MoveStructureNodes{{{2, 2, 2}}, {}});
  const MapEdit edit = draft.take();
  map_.apply(MapEdit{});
  EXPECT_EQ(rebase(edit, *with_room, map_).operations.size(), 1U) << "the same room still";
  map_.apply(with_room_at({3, 3, 3}));
  EXPECT_TRUE(rebase(edit, *with_room, map_).operations.empty());
}

TEST_P(Rebase, MergedIdsAreFollowedAndVanishedOnesDropOut) {
  const auto at = [this](std::uint32_t i) { return old_->landmarks().at_index(i); };
  Draft draft(old_);
  draft.record(MergeLandmark{at(1), at(2)});
  draft.record(MergeLandmark{at(3), at(4)});
  draft.record(RemoveObservation{at(7), world_.ids[0]});
  draft.record(MoveLandmark{at(5), {1, 1, 1}});
  draft.record(MoveKeyframe{world_.ids[4], Se3{}});
  const MapEdit edit = draft.take();
  map_.apply(MergeLandmark{at(2), at(6)});
  map_.apply(MergeLandmark{at(7), at(8)});
  map_.apply(RemoveLandmark{at(3)});
  map_.apply(RemoveLandmark{at(5)});
  map_.apply(RemoveKeyframe{world_.ids[4], world_.ids[3]});
  map_.apply(MapEdit{});
  const MapEdit rebased = rebase(edit, *old_, map_);
  ASSERT_EQ(rebased.operations.size(), 2U);
  const auto& merge = std::get<MergeLandmark>(rebased.operations[0]);
  EXPECT_EQ(merge.id, at(1));
  EXPECT_EQ(merge.into, at(6));
  EXPECT_EQ(std::get<RemoveObservation>(rebased.operations[1]).landmark, at(8));
  EXPECT_EQ(rebased.based_on, map_.version());
}

TEST_P(Rebase, LandmarksOfACulledKeyframeFollowItsAnchor) {
  const Se3 correction = Se3::exp(draw(rng_, 0.3));
  const MapEdit edit = moves_all_by(correction);
  map_.apply(RemoveKeyframe{world_.ids[0], world_.ids[1]});
  map_.apply(MapEdit{});
  const Snapshot culled = map_.snapshot();
  map_.apply(rebase(edit, *old_, *culled));
  expect_moved_by(correction, *culled, map_);
}

TEST_P(Rebase, RefusesEditsThatAdd) {
  Draft draft(old_);
  draft.add(Landmark{});
  const MapEdit edit = draft.take();
  map_.apply(MapEdit{});
  EXPECT_THROW(rebase(edit, *old_, map_), InvariantError);
}

INSTANTIATE_TEST_SUITE_P(Draws, Rebase, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace vsgraphs
