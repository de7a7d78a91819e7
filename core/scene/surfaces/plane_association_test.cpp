#include "core/scene/surfaces/plane_association.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_map.h"
#include "core/scene/surfaces/plane_extraction.h"
#include "core/scene/surfaces/test_surfaces.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A square piece of a surface, 1 m wide, as a keyframe at the world's origin sees it.
SurfacePatch piece(const Eigen::Vector3d& middle, const Eigen::Vector3d& normal) {
  SurfacePatch patch;
  patch.plane = plane_at(middle, normal);
  patch.information = 1e6 * Eigen::Matrix3d::Identity();
  const auto basis = tangent_basis(patch.plane.normal);
  for (double s = -0.5; s <= 0.5; s += 0.1)
    for (double t = -0.5; t <= 0.5; t += 0.1)
      patch.points.push_back((middle + s * basis.col(0) + t * basis.col(1)).cast<float>());
  patch.area_m2 = 1;
  return patch;
}

class PlaneAssociation : public ::testing::Test {
 protected:
  // A plane of its own for each piece, all seen by one new keyframe.
  std::vector<PlaneId> map_pieces(const std::vector<SurfacePatch>& pieces) {
    const KeyframeId keyframe = add_keyframe(map, keyframe_seeing(Camera{}, Se3{}, {}));
    map.apply(
        SetPatches{keyframe, std::make_shared<const KeyframeSurfaces>(KeyframeSurfaces{pieces, false})});
    std::vector<PlaneId> ids;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      ids.push_back(map.planes().next_id());
      MappedPlane plane;
      plane.plane = pieces[i].plane;
      map.apply(AddPlane{ids.back(), plane});
      map.apply(AddPlaneObservation{ids.back(), {keyframe, static_cast<std::uint16_t>(i)}});
    }
    return ids;
  }
  PlaneId associated(const SurfacePatch& patch) const {
    return associate_patches(map, known(), {place(patch, Se3{})}, options)[0];
  }
  std::vector<PlaneId> associated_all(const std::vector<SurfacePatch>& patches) const {
    std::vector<PlacedPatch> placed;
    for (const SurfacePatch& p : patches) placed.push_back(place(p, Se3{}));
    return associate_patches(map, known(), placed, options);
  }
  SurfaceKeeper known() const {
    SurfaceKeeper keeper;
    keeper.gather(map);
    return keeper;
  }
  void classify(PlaneId id, SurfaceRole role) { map.apply(ClassifyPlane{id, role, {}}); }

  Map map;
  PlaneAssociationOptions options;
  const Eigen::Vector3d towards = -Eigen::Vector3d::UnitY(), away = Eigen::Vector3d::UnitY();
};

TEST_F(PlaneAssociation, APieceBesideWhatWasSeenIsTheSamePlane) {
  const PlaneId wall = map_pieces({piece({0, 3, 0}, towards)})[0];
  EXPECT_EQ(associated(piece({1.2, 3.03, 0.2}, {0.03, -1, 0.02})), wall);
}

TEST_F(PlaneAssociation, TheOffsetIsTakenAtThePatchNotThroughTheOrigin) {
  // 40 m from the origin, 0.05 rad are 2 m there and nothing here.
  const PlaneId wall = map_pieces({piece({40, 3, 0}, towards)})[0];
  EXPECT_EQ(associated(piece({40.3, 3, 0}, {0.05, -1, 0})), wall);
  // And equal distances from the origin are no agreement.
  EXPECT_FALSE(associated(piece({40.3, 3.5, 0}, {0.0125, -1, 0})).valid());
}

TEST_F(PlaneAssociation, ClassPlaysNoPartInIt) {
  const PlaneId wall = map_pieces({piece({0, 3, 0}, towards)})[0];
  classify(wall, SurfaceRole::wall);
  SurfacePatch door = piece({0.2, 3, 0}, towards);
  door.votes[static_cast<std::size_t>(SurfaceRole::door)] = 1;
  EXPECT_EQ(associated(door), wall);
  const PlaneId unsure = map_pieces({piece({0.5, 3, 0}, towards)})[0];
  EXPECT_THAT(find_merges(map, known(), {unsure}, options), SizeIs(1));
}

TEST_F(PlaneAssociation, TheOtherSideIsAnotherPlane) {
  map_pieces({piece({0, 3, 0}, towards)});
  EXPECT_FALSE(associated(piece({0, 3, 0}, away)).valid());
  EXPECT_FALSE(associated(piece({0, 3.1, 0}, away)).valid());
}

TEST_F(PlaneAssociation, FarApartOnOnePlaneAreTwo) {
  const PlaneId left = map_pieces({piece({0, 3, 0}, towards)})[0];
  EXPECT_FALSE(associated(piece({4, 3, 0}, towards)).valid()) << "two doors' worth of wall between them";
  const PlaneId right = map_pieces({piece({4, 3, 0}, towards)})[0];
  EXPECT_THAT(find_merges(map, known(), {left, right}, options), IsEmpty());
}

TEST_F(PlaneAssociation, OffsetAndAngleHaveLimitsOnBothAxes) {
  map_pieces({piece({0, 3, 0}, towards)});
  EXPECT_FALSE(associated(piece({0, 3.2, 0}, towards)).valid());
  EXPECT_FALSE(associated(piece({0, 3, 0}, {0.3, -1, 0})).valid());
  EXPECT_FALSE(associated(piece({0, 3, 0}, {0, -1, 0.3})).valid());
  SurfacePatch strip = piece({0, 3, 0}, {0, -1, 0.25});
  strip.information = 400 * Eigen::Matrix3d::Identity();  // 0.05 rad
  EXPECT_TRUE(associated(strip).valid()) << "what is known badly may be farther off";
}

TEST_F(PlaneAssociation, TwoDepthsOfOneImageAreTwoPlanes) {
  const PlaneId wall = map_pieces({piece({0, 3, 0}, towards)})[0];
  const auto ids = associated_all({piece({0.2, 2.92, 0}, towards), piece({-0.3, 3.0, 0.4}, towards)});
  EXPECT_FALSE(ids[0].valid()) << "a cabinet's front 0.08 m before the wall";
  EXPECT_EQ(ids[1], wall) << "the nearer one wins";
}

TEST_F(PlaneAssociation, APosterSeenBesideItsWallBelongsToIt) {
  const PlaneId wall = map_pieces({piece({0, 3, 0}, towards)})[0];
  for (const double before_m : {0.01, 0.02}) {
    const auto ids =
        associated_all({piece({0.2, 3 - before_m, 0}, towards), piece({-0.3, 3.0, 0.4}, towards)});
    EXPECT_EQ(ids[0], wall);
    EXPECT_EQ(ids[1], wall);
  }
}

TEST_F(PlaneAssociation, APosterInADepthImageBelongsToItsWall) {
  const Camera camera;
  World world = World().sheet({-3, 1.2, -3}, {6, 0, 0}, {0, 0, 6}).box({-0.3, 1.182, -0.2}, {0.3, 1.2, 0.2});
  const Se3 pose = looking({0, 0, 0}, {0, 1, 0});
  const PlaneId wall = map_pieces({piece({0, 1.2, 0}, towards)})[0];
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Rng rng(seed, "poster", 0);
    const KeyframeSurfaces seen = extract_planes(view(world, pose, camera, &rng), nullptr, camera, {});
    ASSERT_FALSE(seen.patches.empty());
    for (const SurfacePatch& patch : seen.patches)
      EXPECT_EQ(associate_patches(map, known(), {place(patch, pose)}, options)[0], wall);
  }
}

TEST_F(PlaneAssociation, PlanesThatTurnOutToBeOneAreMergedIntoTheOneSeenMoreOften) {
  const PlaneId first = map_pieces({piece({0, 3, 0}, towards)})[0];
  const PlaneId second = map_pieces({piece({0.8, 3.02, 0}, towards)})[0];
  const KeyframeId third = add_keyframe(map, keyframe_seeing(Camera{}, Se3{}, {}));
  map.apply(SetPatches{third, std::make_shared<const KeyframeSurfaces>(
                                  KeyframeSurfaces{{piece({0.9, 3.02, 0}, towards)}, false})});
  map.apply(AddPlaneObservation{second, {third, 0}});
  const auto merges = find_merges(map, known(), {first, second}, options);
  ASSERT_THAT(merges, SizeIs(1));
  EXPECT_EQ(merges[0].gone, first);
  EXPECT_EQ(merges[0].kept, second);
}

TEST_F(PlaneAssociation, ACabinetFrontIsNotMergedWithItsWallNorAWallWithItsOtherFace) {
  const auto ids =
      map_pieces({piece({0, 3, 0}, towards), piece({0.5, 2.88, 0}, towards), piece({0, 3.1, 0}, away)});
  EXPECT_THAT(find_merges(map, known(), {ids.begin(), ids.end()}, options), IsEmpty());
}

TEST_F(PlaneAssociation, NothingIsMergedTwice) {
  const auto ids =
      map_pieces({piece({0, 3, 0}, towards), piece({0.4, 3, 0}, towards), piece({0.8, 3, 0}, towards)});
  const auto merges = find_merges(map, known(), {ids.begin(), ids.end()}, options);
  ASSERT_THAT(merges, SizeIs(2));
  EXPECT_NE(merges[0].gone, merges[1].gone);
  for (const PlaneMerge& m : merges) EXPECT_NE(m.gone, m.kept);
}

TEST_F(PlaneAssociation, TwoFacesAreOneWallWithAThickness) {
  const auto ids =
      map_pieces({piece({0, 3, 0}, towards), piece({0.3, 3.12, 0}, away), piece({0, 3.4, 0}, away)});
  for (const PlaneId id : ids) classify(id, SurfaceRole::wall);
  const auto other = find_other_face(map, known(), ids[0], options);
  ASSERT_TRUE(other.has_value());
  EXPECT_EQ(other->id, ids[1]) << "the nearest";
  EXPECT_NEAR(other->thickness_m, 0.12, 1e-9);
  EXPECT_EQ(find_other_face(map, known(), ids[1], options)->id, ids[0]);
}

TEST_F(PlaneAssociation, WallsThatFaceEachOtherAcrossASpaceAreNotOne) {
  // Both look into the gap of 0.3 m between them: a shaft, no wall.
  const auto ids = map_pieces({piece({0, 3, 0}, away), piece({0, 3.3, 0}, towards)});
  for (const PlaneId id : ids) classify(id, SurfaceRole::wall);
  EXPECT_FALSE(find_other_face(map, known(), ids[0], options).has_value());
}

TEST_F(PlaneAssociation, FacesTooThickTooFarAsideOrOfAnotherKindAreNotPaired) {
  const auto ids = map_pieces({piece({0, 3, 0}, towards), piece({0, 4, 0}, away), piece({4, 3.1, 0}, away),
                               piece({0, 3.02, 0}, away)});
  for (const PlaneId id : ids) classify(id, SurfaceRole::wall);
  EXPECT_FALSE(find_other_face(map, known(), ids[0], options).has_value());
  const PlaneId cabinet_back = map_pieces({piece({0, 3.2, 0}, away)})[0];
  EXPECT_FALSE(find_other_face(map, known(), ids[0], options).has_value()) << "undecided yet";
  classify(cabinet_back, SurfaceRole::wall);
  EXPECT_TRUE(find_other_face(map, known(), ids[0], options).has_value());
}

TEST_F(PlaneAssociation, ThePointsOfAPlaneMoveWithACorrectedKeyframe) {
  const PlaneId wall = map_pieces({piece({0, 3, 0}, towards)})[0];
  map.apply(MoveKeyframe{KeyframeId{0, 0}, standing_at(5, 1, 0)});
  const SurfaceKeeper keeper = known();
  const PlaneExtent& extent = keeper.find(wall)->extent();
  EXPECT_TRUE(extent.near({5, 4, 0}, 0.1));
  EXPECT_FALSE(extent.near({0, 4, 0}, 0.1));
  for (const Eigen::Vector3d& p : extent.points()) EXPECT_GT(p.x(), 4.3);
}

}  // namespace
}  // namespace vsgraphs
