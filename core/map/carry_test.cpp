#include "core/map/carry.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/map/test_full_map.h"

namespace vsgraphs {
namespace {

using namespace test;

constexpr double quarter_turn = std::numbers::pi / 2;

// Three keyframes that see the same points and have patches.
class CarryTest : public ::testing::Test {
 protected:
  CarryTest() {
    for (int i = 0; i < 3; ++i) {
      ids_.push_back(add_keyframe(map_, keyframe_seeing(camera_, standing_at(0.1 * i), points_)));
      map_.apply(SetPatches{ids_.back(), some_patches(2)});
    }
    corrections_.resize(map_.keyframes().index_bound());
  }
  PlaneId add_plane(const std::vector<PlaneObservation>& observations) {
    const PlaneId id = map_.planes().next_id();
    map_.apply(AddPlane{id, MappedPlane{wall_, SurfaceRole::wall, {}, {}, {}, 0}});
    for (const PlaneObservation& o : observations) map_.apply(AddPlaneObservation{id, o});
    return id;
  }
  Se3& correction(int k) { return corrections_[ids_[static_cast<std::size_t>(k)].index]; }
  Carry carried() const { return {map_, corrections_}; }

  const AnchoredPlane wall_{-Eigen::Vector3d::UnitZ(), {0, 0, 3}, 0.01};
  Camera camera_;
  Points points_ = point_grid(3, 2);
  Map map_;
  std::vector<KeyframeId> ids_;
  Corrections corrections_;
};

TEST_F(CarryTest, ALandmarkMovesAndTurnsWithTheFirstThatSawIt) {
  const LandmarkId id = add_landmark(map_, points_[0], 0, {{ids_[1], 0}, {ids_[0], 0}});
  correction(0) = standing_at(5);
  correction(1) = Se3(so3_exp({0, quarter_turn, 0}), {1, 2, 3});
  for (const EditOperation& move : carry(map_, corrections_)) map_.apply(move);
  const Landmark& landmark = *map_.landmarks().find(id);
  EXPECT_LT((landmark.point_in_world - correction(1) * points_[0]).norm(), 1e-12);
  EXPECT_LT((landmark.appearance.view_direction - Eigen::Vector3f::UnitX()).norm(), 1e-6F);
}

TEST_F(CarryTest, KeyframesMoveByTheirOwnCorrection) {
  correction(2) = Se3(so3_exp({0.1, 0, 0}), {1, 0, 0});
  const Se3 before = map_.keyframes().find(ids_[2])->world_from_camera;
  for (const EditOperation& move : carry(map_, corrections_)) map_.apply(move);
  EXPECT_TRUE(map_.keyframes().find(ids_[2])->world_from_camera.matrix().isApprox(
      (correction(2) * before).matrix(), 1e-12));
  EXPECT_EQ(map_.keyframes().find(ids_[0])->world_from_camera.matrix(), Se3{}.matrix());
}

TEST_F(CarryTest, APlaneSeenByTwoMovesByTheMean) {
  const PlaneId id = add_plane({{ids_[0], 0}, {ids_[1], 0}});
  correction(0) = standing_at(0, 0, 0.2);
  const AnchoredPlane moved = carried().plane(id)->plane;
  EXPECT_LT((moved.normal - wall_.normal).norm(), 1e-12);
  EXPECT_NEAR(moved.d(), wall_.d() + 0.1, 1e-12);
}

TEST_F(CarryTest, APlaneOfACulledKeyframeFollowsItsAnchor) {
  const PlaneId id = add_plane({{ids_[0], 0}});
  map_.apply(RemoveKeyframe{ids_[0], ids_[2]});
  correction(0) = standing_at(9, 9, 9);
  correction(2) = standing_at(1, 2, 3);
  EXPECT_EQ(carried().plane(id)->plane.d(), wall_.transformed(correction(2)).d());
}

TEST_F(CarryTest, AMarkerMovesWithTheFirstThatSawItWhereItHangs) {
  const Se3 hung = standing_at(0, 0, 2);
  map_.apply(AddMarker{{7}, {0.16, hung, {}}});
  map_.apply(AddMarkerObservation{{7}, {ids_[0], standing_at(40), Matrix6d::Identity()}});  // a stray one
  for (const int k : {1, 2})
    map_.apply(AddMarkerObservation{
        {7}, {ids_[static_cast<std::size_t>(k)], standing_at(-0.1 * k, 0, 2), Matrix6d::Identity()}});
  correction(0) = standing_at(9, 9, 9);
  correction(1) = Se3(so3_exp({0, quarter_turn, 0}), {1, 2, 3});
  EXPECT_TRUE(carried().marker({7})->world_from_marker.matrix().isApprox((correction(1) * hung).matrix()));
  map_.apply(RemoveKeyframe{ids_[1], ids_[2]});
  correction(2) = standing_at(-1);
  EXPECT_TRUE(carried().marker({7})->world_from_marker.matrix().isApprox((correction(2) * hung).matrix()));
}

TEST_F(CarryTest, WhatNobodySeesStays) {
  map_.apply(AddLandmark{map_.landmarks().next_id(), Landmark{}});
  const PlaneId plane = add_plane({});
  map_.apply(AddMarker{{7}, {0.16, Se3{}, {}}});
  EXPECT_FALSE(carried().landmark(map_.landmarks().at_index(0)).has_value());
  EXPECT_FALSE(carried().plane(plane).has_value());
  EXPECT_FALSE(carried().marker({7}).has_value());
  EXPECT_FALSE(carried().structure_nodes().has_value());
  EXPECT_EQ(carry(map_, corrections_).size(), 3U);  // the keyframes
}

TEST_F(CarryTest, RoomsGoWithTheirWallsAndFloorsWithTheirRooms) {
  const PlaneId near = add_plane({{ids_[0], 0}}), far = add_plane({{ids_[1], 0}});
  FoundStructure structure = some_structure(near, far);
  structure.rooms[0].walls = {near, far};
  structure.rooms[1].walls = {far};
  map_.apply(SetStructure{std::make_shared<const FoundStructure>(structure)});
  correction(1) = standing_at(2, 0, 0);
  const auto nodes = carried().structure_nodes();
  ASSERT_TRUE(nodes.has_value());
  EXPECT_LT((nodes->rooms[0] - structure.room_nodes[0] - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((nodes->rooms[1] - structure.room_nodes[1] - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((nodes->floors[0] - structure.floor_nodes[0] - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST_F(CarryTest, WhatAnotherMapKnowsIsLeftOut) {
  add_landmark(map_, points_[0], 0, {{ids_[0], 0}});
  const Snapshot known = map_.snapshot();
  const KeyframeId later = add_keyframe(map_, keyframe_seeing(camera_, standing_at(1), points_));
  const LandmarkId made = add_landmark(map_, points_[1], 1, {{later, 1}});
  corrections_.resize(map_.keyframes().index_bound());
  const auto moves = carry(map_, corrections_, known.get());
  ASSERT_EQ(moves.size(), 2U);
  EXPECT_EQ(std::get<MoveKeyframe>(moves[0]).id, later);
  EXPECT_EQ(std::get<MoveLandmark>(moves[1]).id, made);
}

}  // namespace
}  // namespace vsgraphs
