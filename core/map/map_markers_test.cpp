#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

constexpr MarkerId seven{7};

class MapMarkers : public ::testing::Test {
 protected:
  MapMarkers() {
    for (int k = 0; k < 4; ++k)
      keyframes.push_back(add_keyframe(map, keyframe_seeing(Camera{}, standing_at(0.5 * k), {})));
    map.apply(AddMarker{seven, {0.16, hanging_at(1, 0, 2), {}}});
  }
  // Towards cameras that look along z.
  static Se3 hanging_at(double x, double y, double z) {
    const Eigen::AngleAxisd half_turn(std::numbers::pi, Eigen::Vector3d::UnitX());
    return {half_turn.toRotationMatrix(), {x, y, z}};
  }
  void see(std::size_t k, const Se3& world_from_marker) {
    const Se3& pose = map.keyframes().find(keyframes[k])->world_from_camera;
    map.apply(AddMarkerObservation{seven, {keyframes[k], pose.inverse() * world_from_marker}});
  }
  const MappedMarker& marker() const { return *map.markers().at(seven); }

  Map map;
  std::vector<KeyframeId> keyframes;
};

TEST_F(MapMarkers, ANumberIsMappedOnce) {
  map.apply(AddMarker{seven, {0.5, hanging_at(3, 0, 2), {}}});
  ASSERT_EQ(map.markers().size(), 1U);
  EXPECT_EQ(marker().size_m, 0.16);
}

TEST_F(MapMarkers, OperationsOnWhatIsGoneDoNothing) {
  const MarkerId gone{8};
  map.apply(MoveMarker{gone, {}});
  map.apply(AddMarkerObservation{gone, {keyframes[0], {}}});
  map.apply(RemoveMarkerObservations{gone, keyframes[0]});
  map.apply(RemoveMarker{gone});
  map.apply(AddMarkerObservation{seven, {KeyframeId{99, 0}, {}}});
  EXPECT_EQ(map.markers().size(), 1U);
  EXPECT_TRUE(marker().observations.empty());
}

TEST_F(MapMarkers, SnapshotsDoNotChange) {
  see(0, hanging_at(1, 0, 2));
  const Snapshot before = map.snapshot();
  see(1, hanging_at(1, 0, 2));
  map.apply(MoveMarker{seven, hanging_at(1.5, 0, 2)});
  EXPECT_EQ(before->markers().at(seven)->observations.size(), 1U);
  EXPECT_EQ(before->markers().at(seven)->world_from_marker.translation().x(), 1);
  EXPECT_EQ(marker().observations.size(), 2U);
  EXPECT_EQ(marker().world_from_marker.translation().x(), 1.5);
}

TEST_F(MapMarkers, ItGoesWithItsLastObservation) {
  see(0, hanging_at(1, 0, 2));
  see(1, hanging_at(1, 0, 2));
  map.apply(RemoveMarkerObservations{seven, keyframes[0]});
  ASSERT_EQ(map.markers().size(), 1U);
  map.apply(RemoveMarkerObservations{seven, keyframes[1]});
  EXPECT_TRUE(map.markers().empty());
}

TEST_F(MapMarkers, WhatACulledKeyframeSawStandsWhereItStood) {
  see(1, hanging_at(1, 0, 2));
  map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  map.apply(MoveKeyframe{keyframes[0], standing_at(0.1)});
  const MarkerSightings sightings = map.sightings(marker());
  ASSERT_EQ(sightings.places.size(), 1U);
  EXPECT_LT((sightings.places[0].world_from_marker.translation() - Eigen::Vector3d(1.1, 0, 2)).norm(), 1e-12);
}

TEST_F(MapMarkers, AStrayReadingIsSetAsideAndASecondPrintIsFound) {
  for (std::size_t k = 0; k < 3; ++k) see(k, hanging_at(1 + 0.05 * static_cast<double>(k), 0, 2));
  see(3, hanging_at(4, 0, 2));
  MarkerSightings sightings = map.sightings(marker());
  ASSERT_EQ(sightings.places.size(), 2U);
  EXPECT_EQ(sightings.places[0].observations, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_FALSE(sightings.in_two_places());
  see(2, hanging_at(4, 0, 2));
  EXPECT_TRUE(map.sightings(marker()).in_two_places());
}

TEST_F(MapMarkers, ThePlaceSeenMoreOftenComesFirst) {
  see(0, hanging_at(4, 0, 2));
  see(1, hanging_at(1, 0, 2));
  EXPECT_EQ(map.sightings(marker()).places[0].observations, (std::vector<std::size_t>{0})) << "the older one";
  see(2, hanging_at(1, 0, 2));
  EXPECT_EQ(map.sightings(marker()).places[0].observations, (std::vector<std::size_t>{1, 2}));
}

TEST_F(MapMarkers, TheTwoFacesOfAWallAreTwoPlaces) {
  const Se3 other_face(Eigen::Matrix3d::Identity(), {1, 0, 2.12});
  for (std::size_t k = 0; k < 2; ++k) see(k, hanging_at(1, 0, 2));
  for (std::size_t k = 2; k < 4; ++k) see(k, other_face);
  EXPECT_TRUE(map.sightings(marker()).in_two_places());
}

TEST_F(MapMarkers, ACorrectedKeyframeMakesTwoPlacesOne) {
  for (std::size_t k = 0; k < 2; ++k) see(k, hanging_at(1, 0, 2));
  for (std::size_t k = 2; k < 4; ++k) see(k, hanging_at(2, 0, 2));
  ASSERT_TRUE(map.sightings(marker()).in_two_places());
  for (std::size_t k = 2; k < 4; ++k) {
    const Se3 drifted = map.keyframes().find(keyframes[k])->world_from_camera;
    map.apply(MoveKeyframe{keyframes[k], Se3(Eigen::Matrix3d::Identity(), {-1, 0, 0}) * drifted});
  }
  EXPECT_EQ(map.sightings(marker()).places.size(), 1U);
}

std::uint64_t hash_of(EditOperation operation) {
  MapEdit edit;
  edit.operations.push_back(std::move(operation));
  return edit.hash();
}

TEST(EditOfMarkers, EveryValueCounts) {
  const Se3 moved(Eigen::Matrix3d::Identity(), {1e-9, 0, 0});
  const KeyframeId a{0, 0}, b{1, 0};
  const Matrix6d eye = Matrix6d::Identity(), wider = 2 * eye;
  const std::vector<EditOperation> operations = {
      AddMarker{{1}, {0.1, {}, {}}},
      AddMarker{{2}, {0.1, {}, {}}},
      AddMarker{{1}, {0.2, {}, {}}},
      AddMarker{{1}, {0.1, moved, {}}},
      RemoveMarker{{1}},
      RemoveMarker{{2}},
      MoveMarker{{1}, {}},
      MoveMarker{{2}, {}},
      MoveMarker{{1}, moved},
      AddMarkerObservation{{1}, {a, {}, eye}},
      AddMarkerObservation{{2}, {a, {}, eye}},
      AddMarkerObservation{{1}, {b, {}, eye}},
      AddMarkerObservation{{1}, {a, moved, eye}},
      AddMarkerObservation{{1}, {a, {}, wider}},
      RemoveMarkerObservations{{1}, a},
      RemoveMarkerObservations{{2}, a},
      RemoveMarkerObservations{{1}, b},
  };
  std::set<std::uint64_t> hashes;
  for (const EditOperation& operation : operations) {
    EXPECT_TRUE(hashes.insert(hash_of(operation)).second) << "operation kind " << operation.index();
    EXPECT_TRUE(hashes.contains(hash_of(operation)));
  }
}

}  // namespace
}  // namespace vsgraphs
