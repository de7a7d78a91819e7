// Planes in the map: what belongs to whom after every operation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/draft.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SurfacePatch patch_at(double z) {
  SurfacePatch patch;
  patch.plane = {-Eigen::Vector3d::UnitZ(), {0, 0, z}, 0};
  patch.information = Eigen::Matrix3d::Identity();
  patch.points = {{0, 0, static_cast<float>(z)}};
  return patch;
}

std::shared_ptr<const KeyframeSurfaces> patches_at(const std::vector<double>& depths, bool labelled = false) {
  auto surfaces = std::make_shared<KeyframeSurfaces>();
  for (const double z : depths) surfaces->patches.push_back(patch_at(z));
  surfaces->labelled = labelled;
  return surfaces;
}

// Two keyframes with two patches each; plane a has patch 0 of both, plane b patch 1 of the first.
class MapPlanesTest : public ::testing::Test {
 protected:
  MapPlanesTest() {
    const Camera camera;
    for (int k = 0; k < 2; ++k) {
      keyframes.push_back(add_keyframe(map, keyframe_seeing(camera, standing_at(k), {})));
      map.apply(SetPatches{keyframes.back(), patches_at({2, 3})});
    }
    a = add_plane(2);
    b = add_plane(3);
    map.apply(AddPlaneObservation{a, {keyframes[0], 0}});
    map.apply(AddPlaneObservation{a, {keyframes[1], 0}});
    map.apply(AddPlaneObservation{b, {keyframes[0], 1}});
  }
  PlaneId add_plane(double z) {
    const PlaneId id = map.planes().next_id();
    MappedPlane plane;
    plane.plane = patch_at(z).plane;
    map.apply(AddPlane{id, plane});
    return id;
  }
  const MappedPlane& plane(PlaneId id) const { return *map.planes().find(id); }

  Map map;
  std::vector<KeyframeId> keyframes;
  PlaneId a, b;
};

TEST_F(MapPlanesTest, AnObservationIsNotCountedTwiceAndNeedsAPatch) {
  map.apply(AddPlaneObservation{a, {keyframes[0], 0}});
  map.apply(AddPlaneObservation{a, {keyframes[0], 7}});
  map.apply(AddPlaneObservation{a, {KeyframeId{40, 0}, 0}});
  EXPECT_THAT(plane(a).observations,
              ElementsAre(PlaneObservation{keyframes[0], 0}, PlaneObservation{keyframes[1], 0}));
}

TEST_F(MapPlanesTest, APlaneLastsAsLongAsItsObservations) {
  map.apply(RemovePlaneObservation{a, {keyframes[0], 0}});
  EXPECT_THAT(plane(a).observations, ElementsAre(PlaneObservation{keyframes[1], 0}));
  map.apply(RemovePlaneObservation{a, {keyframes[1], 0}});
  EXPECT_FALSE(map.planes().contains(a));
  EXPECT_TRUE(map.planes().contains(b));
}

TEST_F(MapPlanesTest, NewPatchesTakeThePlaceOfTheOldAndOfTheirObservations) {
  map.apply(SetPatches{keyframes[0], patches_at({5}, true)});
  EXPECT_THAT(plane(a).observations, ElementsAre(PlaneObservation{keyframes[1], 0}));
  EXPECT_FALSE(map.planes().contains(b)) << "nobody else had seen it";
  EXPECT_DOUBLE_EQ(map.patch({keyframes[0], 0})->plane.anchor.z(), 5);
  EXPECT_EQ(map.patch({keyframes[0], 1}), nullptr);
  EXPECT_TRUE(map.keyframes().find(keyframes[0])->patches->labelled);
}

TEST_F(MapPlanesTest, IdsAreNotTakenFromTheNumberOfPlanes) {
  map.apply(RemovePlane{a});
  ASSERT_EQ(map.planes().size(), 1U);
  const PlaneId c = add_plane(4), d = add_plane(5);
  EXPECT_NE(c, a);
  EXPECT_NE(c, b);
  EXPECT_NE(d, b);
  EXPECT_DOUBLE_EQ(plane(b).plane.anchor.z(), 3) << "a new plane was put over an old one";
  EXPECT_EQ(map.planes().find(a), nullptr) << "a stale id finds somebody else's plane";
}

TEST_F(MapPlanesTest, MergingBringsObservationsAndVotesAndLeavesATrail) {
  RoleVotes votes{};
  votes[static_cast<std::size_t>(SurfaceRole::wall)] = 1;
  map.apply(ClassifyPlane{a, SurfaceRole::wall, votes});
  votes[static_cast<std::size_t>(SurfaceRole::door)] = 0.5F;
  map.apply(ClassifyPlane{b, SurfaceRole::undecided, votes});
  map.apply(MergePlane{b, a});
  EXPECT_THAT(plane(a).observations,
              ElementsAre(PlaneObservation{keyframes[0], 0}, PlaneObservation{keyframes[1], 0},
                          PlaneObservation{keyframes[0], 1}));
  EXPECT_FLOAT_EQ(plane(a).votes[static_cast<std::size_t>(SurfaceRole::wall)], 2);
  EXPECT_FLOAT_EQ(plane(a).votes[static_cast<std::size_t>(SurfaceRole::door)], 0.5F);
  EXPECT_EQ(plane(a).role, SurfaceRole::wall);
  EXPECT_FALSE(map.planes().contains(b));
  EXPECT_EQ(map.planes().resolve(b), a);
}

TEST_F(MapPlanesTest, AnObservationBothHaveIsKeptOnce) {
  map.apply(AddPlaneObservation{b, {keyframes[1], 0}});
  map.apply(MergePlane{b, a});
  EXPECT_THAT(plane(a).observations, SizeIs(3));
}

TEST_F(MapPlanesTest, TwoFacesKnowEachOtherAndTheThickness) {
  map.apply(PairFaces{a, b, 0.12});
  EXPECT_EQ(plane(a).other_face, b);
  EXPECT_EQ(plane(b).other_face, a);
  EXPECT_DOUBLE_EQ(plane(a).thickness_m, 0.12);
  EXPECT_DOUBLE_EQ(plane(b).thickness_m, 0.12);
}

TEST_F(MapPlanesTest, PairingAnewPartsBothFromTheirFormerPartners) {
  const PlaneId c = add_plane(4), d = add_plane(5);
  map.apply(PairFaces{a, b, 0.1});
  map.apply(PairFaces{c, d, 0.2});
  map.apply(PairFaces{a, c, 0.3});
  EXPECT_EQ(plane(a).other_face, c);
  EXPECT_EQ(plane(c).other_face, a);
  for (const PlaneId left : {b, d}) {
    EXPECT_FALSE(plane(left).other_face.valid());
    EXPECT_EQ(plane(left).thickness_m, 0);
  }
}

TEST_F(MapPlanesTest, FacesPartWhereToldAndWhereOneGoes) {
  map.apply(PairFaces{a, b, 0.1});
  map.apply(PairFaces{b, {}, 0});
  EXPECT_FALSE(plane(a).other_face.valid());
  EXPECT_FALSE(plane(b).other_face.valid());
  map.apply(PairFaces{a, b, 0.1});
  map.apply(RemovePlaneObservation{b, {keyframes[0], 1}});  // its last
  EXPECT_FALSE(plane(a).other_face.valid());
  EXPECT_EQ(plane(a).thickness_m, 0);
  const PlaneId c = add_plane(4);
  map.apply(PairFaces{a, c, 0.1});
  map.apply(MergePlane{c, a});
  EXPECT_FALSE(plane(a).other_face.valid()) << "a plane was paired with itself";
}

TEST_F(MapPlanesTest, APlaneIsNotItsOwnOtherFace) {
  map.apply(PairFaces{a, a, 0.1});
  EXPECT_FALSE(plane(a).other_face.valid());
}

TEST_F(MapPlanesTest, PatchesOutliveTheirKeyframeAndMoveWithItsAnchor) {
  map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  const PlaneObservation of_retired{keyframes[1], 0};
  ASSERT_NE(map.patch(of_retired), nullptr);
  EXPECT_DOUBLE_EQ(map.patch(of_retired)->plane.anchor.z(), 2);
  EXPECT_THAT(plane(a).observations, SizeIs(2)) << "what it saw is not forgotten";
  map.apply(MoveKeyframe{keyframes[0], standing_at(0, 0, 0.5)});
  const Se3 pose = *map.resolve({of_retired.keyframe, Se3{}});
  EXPECT_TRUE((pose * map.patch(of_retired)->plane.anchor).isApprox(Eigen::Vector3d(1, 0, 2.5)));
}

TEST_F(MapPlanesTest, OperationsOnVanishedPlanesDoNothing) {
  map.apply(RemovePlane{b});
  const PlaneId gone = b;
  map.apply(AddPlaneObservation{gone, {keyframes[0], 1}});
  map.apply(RemovePlaneObservation{gone, {keyframes[0], 1}});
  map.apply(MovePlane{gone, {}});
  map.apply(ClassifyPlane{gone, SurfaceRole::wall, {}});
  map.apply(MergePlane{gone, a});
  map.apply(MergePlane{a, gone});
  map.apply(MergePlane{a, a});
  map.apply(PairFaces{a, gone, 0.1});
  map.apply(SetPatches{KeyframeId{50, 0}, patches_at({1})});
  EXPECT_EQ(map.planes().size(), 1U);
  EXPECT_THAT(plane(a).observations, SizeIs(2));
  EXPECT_FALSE(plane(a).other_face.valid());
}

TEST_F(MapPlanesTest, UpIsAUnitVectorOnceItIsKnown) {
  EXPECT_FALSE(map.up_in_world().has_value());
  map.apply(vsgraphs::SetUp{{0, -2, 0}});
  EXPECT_TRUE(map.up_in_world()->isApprox(-Eigen::Vector3d::UnitY()));
}

TEST_F(MapPlanesTest, ASnapshotKeepsItsPlanes) {
  const Snapshot before = map.snapshot();
  map.apply(MovePlane{a, patch_at(9).plane});
  map.apply(ClassifyPlane{a, SurfaceRole::wall, {}});
  map.apply(PairFaces{a, b, 0.1});
  map.apply(SetPatches{keyframes[1], patches_at({7})});
  map.apply(vsgraphs::SetUp{{0, 0, 1}});
  map.apply(MergePlane{b, a});
  const MappedPlane& then = *before->planes().find(a);
  EXPECT_DOUBLE_EQ(then.plane.anchor.z(), 2);
  EXPECT_EQ(then.role, SurfaceRole::undecided);
  EXPECT_FALSE(then.other_face.valid());
  EXPECT_THAT(then.observations, SizeIs(2));
  EXPECT_EQ(before->planes().size(), 2U);
  EXPECT_DOUBLE_EQ(before->patch({keyframes[1], 0})->plane.anchor.z(), 2);
  EXPECT_FALSE(before->up_in_world().has_value());
}

TEST_F(MapPlanesTest, ADraftRecordsAPlaneWithoutWhatItCannotKnow) {
  Draft draft(map.snapshot());
  MappedPlane copied = plane(a);
  const PlaneId id = draft.add(copied);
  EXPECT_THAT(draft.map().planes().find(id)->observations, IsEmpty());
  draft.record(AddPlaneObservation{id, {keyframes[1], 1}});
  map.apply(draft.take());
  EXPECT_THAT(plane(id).observations, ElementsAre(PlaneObservation{keyframes[1], 1}));
}

}  // namespace
}  // namespace vsgraphs
