// Several maps with disjoint ids, and two becoming one.
#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

MapEdit one(EditOperation operation) { return {0, {std::move(operation)}}; }

struct SmallMap {
  Camera camera;
  Points points = point_grid(4, 3);
  Map map;
  std::vector<KeyframeId> keyframes;
  std::vector<LandmarkId> landmarks;
  PlaneId plane;

  explicit SmallMap(const FirstIds& first = {}) {
    map.apply(OpenMap{first, 7});
    for (const double x : {0.0, 0.1, 0.2})
      keyframes.push_back(add_keyframe(map, keyframe_seeing(camera, standing_at(x), points)));
    landmarks = add_landmarks(map, points, keyframes);
    auto surfaces = std::make_shared<KeyframeSurfaces>();
    surfaces->patches.resize(1);
    map.apply(SetPatches{keyframes[0], surfaces});
    plane = map.planes().next_id();
    MappedPlane wall;
    wall.plane = {{0, 0, -1}, {0, 0, 2}, 0};
    map.apply(AddPlane{plane, wall});
    map.apply(AddPlaneObservation{plane, {keyframes[0], 0}});
    map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  }
};

TEST(OpenMap, NewIdsAndVersionsGoOnBehindOthers) {
  const SmallMap first;
  const SmallMap second(first.map.unused_ids());
  EXPECT_EQ(second.map.version(), 7U);
  EXPECT_EQ(second.keyframes[0].index, 64U);
  EXPECT_EQ(second.plane.index, 64U);
  for (const KeyframeId id : second.keyframes) {
    EXPECT_FALSE(first.map.resolve({id, Se3{}}).has_value());
    EXPECT_TRUE(second.map.resolve({id, Se3{}}).has_value()) << "culled ones too";
  }
  for (const LandmarkId id : second.landmarks) EXPECT_FALSE(first.map.landmarks().contains(id));
  EXPECT_FALSE(second.map.resolve({first.keyframes[0], Se3{}}).has_value());
}

TEST(AbsorbMap, TakesAllInWhereItIsMovedTo) {
  SmallMap older, younger(SmallMap().map.unused_ids());
  younger.map.apply(vsgraphs::SetUp{{0, -1, 0}});
  const Se3 moved(so3_exp({0, 0.5, 0}), {3, 0, 1});
  const Snapshot before = older.map.snapshot();
  const Snapshot other = younger.map.snapshot();
  older.map.apply(AbsorbMap{other, moved});
  const Map& both = older.map;

  EXPECT_EQ(both.keyframes().size(), 4U);
  EXPECT_EQ(both.landmarks().size(), 24U);
  EXPECT_EQ(both.planes().size(), 2U);
  for (const KeyframeId id : younger.keyframes) {
    const Se3 expected = moved * *other->resolve({id, Se3{}});
    EXPECT_TRUE(both.resolve({id, Se3{}})->matrix().isApprox(expected.matrix(), 1e-12)) << id.index;
  }
  for (std::size_t i = 0; i < younger.points.size(); ++i) {
    const Landmark& landmark = *both.landmarks().find(younger.landmarks[i]);
    EXPECT_LT((landmark.point_in_world - moved * younger.points[i]).norm(), 1e-12);
    EXPECT_EQ(landmark.observations.size(), 2U);
    EXPECT_LT(
        (landmark.appearance.view_direction - (moved.rotation() * Eigen::Vector3d::UnitZ()).cast<float>())
            .norm(),
        1e-6F);
  }
  const AnchoredPlane& wall = both.planes().find(younger.plane)->plane;
  EXPECT_NEAR(wall.signed_distance(moved * Eigen::Vector3d(1, 1, 2)), 0, 1e-12);
  EXPECT_NEAR(wall.signed_distance(moved * Eigen::Vector3d(1, 1, 1)), 1, 1e-12);
  EXPECT_LT((*both.up_in_world() - moved.rotation() * Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);

  for (const KeyframeId id : older.keyframes)
    EXPECT_TRUE(both.resolve({id, Se3{}})->matrix() == before->resolve({id, Se3{}})->matrix());
  EXPECT_EQ(before->keyframes().size(), 2U) << "what was handed out stays";
  EXPECT_TRUE(other->keyframes().find(younger.keyframes[0])->world_from_camera.matrix().isIdentity(0));
}

TEST(AbsorbMap, KeepsItsOwnUpAndNeverGivesARoomNumberTwice) {
  SmallMap older, younger(SmallMap().map.unused_ids());
  older.map.apply(vsgraphs::SetUp{{0, -1, 0}});
  younger.map.apply(vsgraphs::SetUp{{1, 0, 0}});
  auto structure = std::make_shared<FoundStructure>();
  structure->rooms.resize(1);
  structure->next_number = 9;
  younger.map.apply(SetStructure{structure});
  older.map.apply(AbsorbMap{younger.map.snapshot(), Se3{}});
  EXPECT_EQ(*older.map.up_in_world(), Eigen::Vector3d(0, -1, 0));
  EXPECT_TRUE(older.map.structure().rooms.empty()) << "to be sought again";
  EXPECT_EQ(older.map.structure().next_number, 9U);
}

TEST(AbsorbMap, MarkersMoveAndOneThatBothKnowIsOne) {
  SmallMap older, younger(SmallMap().map.unused_ids());
  constexpr MarkerId shared{3}, own{9};
  const auto hang = [](SmallMap& small, MarkerId id, double x) {
    const Se3 seen = standing_at(x);
    small.map.apply(AddMarker{id, {0.16, seen, {}}});
    small.map.apply(AddMarkerObservation{id, {small.keyframes[0], seen}});
  };
  hang(older, shared, 1);
  hang(younger, shared, -2);
  hang(younger, own, -3);
  const Se3 moved = standing_at(3);
  older.map.apply(AbsorbMap{younger.map.snapshot(), moved});
  const Markers& markers = older.map.markers();
  ASSERT_EQ(markers.size(), 2U);
  EXPECT_EQ(markers.at(shared)->observations.size(), 2U);
  EXPECT_TRUE(markers.at(shared)->world_from_marker.matrix().isApprox(standing_at(1).matrix(), 1e-12));
  EXPECT_EQ(markers.at(own)->observations.size(), 1U);
  const Se3 expected = moved * standing_at(-3);
  EXPECT_TRUE(markers.at(own)->world_from_marker.matrix().isApprox(expected.matrix(), 1e-12));
}

TEST(AbsorbMap, HashSaysWhatAndWhere) {
  SmallMap younger(SmallMap().map.unused_ids());
  const Snapshot as_it_was = younger.map.snapshot();
  const auto hash = [](const Snapshot& map, double x) { return one(AbsorbMap{map, standing_at(x)}).hash(); };
  EXPECT_EQ(hash(as_it_was, 1), hash(as_it_was, 1));
  EXPECT_NE(hash(as_it_was, 1), hash(as_it_was, 2));
  younger.map.apply(MoveLandmark{younger.landmarks[0], {1, 2, 3}});
  EXPECT_NE(hash(younger.map.snapshot(), 1), hash(as_it_was, 1));
  EXPECT_NE(one(OpenMap{{1, 2, 3}, 4}).hash(), one(OpenMap{{1, 2, 4}, 4}).hash());
}

TEST(KeyframeOfFrame, IsTheOneMadeOfIt) {
  SmallMap small;
  Keyframe keyframe = keyframe_seeing(small.camera, standing_at(1), small.points);
  keyframe.frame_index = 42;
  const KeyframeId id = add_keyframe(small.map, keyframe);
  EXPECT_EQ(small.map.keyframe_of_frame(42), id);
  EXPECT_FALSE(small.map.keyframe_of_frame(41).valid());
}

}  // namespace
}  // namespace vsgraphs
