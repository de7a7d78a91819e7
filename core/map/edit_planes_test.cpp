// Edits of planes are told apart by their hashes, so that two runs can be compared.
#include <gtest/gtest.h>

#include <set>

#include "core/map/edit.h"

namespace vsgraphs {
namespace {

std::uint64_t hash_of(EditOperation operation) {
  MapEdit edit;
  edit.operations.push_back(std::move(operation));
  return edit.hash();
}

// All hashes differ, and each is the same when worked out again.
void expect_told_apart(const std::vector<EditOperation>& operations) {
  std::set<std::uint64_t> hashes;
  for (const EditOperation& operation : operations) {
    EXPECT_TRUE(hashes.insert(hash_of(operation)).second) << "operation kind " << operation.index();
    EXPECT_TRUE(hashes.contains(hash_of(operation)));
  }
}

SetPatches patches(double offset_m, double information, float vote, bool labelled) {
  auto surfaces = std::make_shared<KeyframeSurfaces>();
  surfaces->patches.resize(1);
  surfaces->patches[0].plane.offset_m = offset_m;
  surfaces->patches[0].information(2, 2) = information;
  surfaces->patches[0].votes[1] = vote;
  surfaces->labelled = labelled;
  return {{0, 0}, surfaces};
}

TEST(EditOfPlanes, KindsOfOperationsDiffer) {
  const PlaneId a{0, 0}, b{1, 0};
  expect_told_apart({RemovePlane{a}, MergePlane{a, b}, PairFaces{a, b, 0}, MovePlane{a, {}}, ClassifyPlane{a},
                     AddPlane{a, {}}, AddPlaneObservation{a, {}}, RemovePlaneObservation{a, {}},
                     vsgraphs::SetUp{{0, 0, 1}}, patches(0, 0, 0, false)});
}

TEST(EditOfPlanes, EveryValueCounts) {
  const PlaneId a{0, 0}, b{1, 0}, later{0, 1};
  expect_told_apart({RemovePlane{a}, RemovePlane{b}, RemovePlane{later}});
  expect_told_apart({MergePlane{a, b}, MergePlane{b, a}});
  expect_told_apart(
      {PairFaces{a, b, 0.1}, PairFaces{a, b, 0.2}, PairFaces{a, {}, 0.1}, PairFaces{b, a, 0.1}});
  expect_told_apart({AddPlaneObservation{a, {{0, 0}, 0}}, AddPlaneObservation{a, {{0, 0}, 1}},
                     AddPlaneObservation{a, {{1, 0}, 0}}, AddPlaneObservation{b, {{0, 0}, 0}}});
  expect_told_apart({RemovePlaneObservation{a, {{0, 0}, 0}}, RemovePlaneObservation{a, {{0, 0}, 1}}});
  expect_told_apart({vsgraphs::SetUp{{0, 0, 1}}, vsgraphs::SetUp{{0, 1e-9, 1}}});
  expect_told_apart({patches(0, 0, 0, false), patches(1, 0, 0, false), patches(0, 1, 0, false),
                     patches(0, 0, 1, false), patches(0, 0, 0, true)});
}

TEST(EditOfPlanes, PlanesAndClassesCount) {
  const PlaneId a{0, 0};
  AnchoredPlane turned, shifted, anchored;
  turned.normal = Eigen::Vector3d::UnitX();
  shifted.offset_m = 1e-12;
  anchored.anchor.x() = 1;
  expect_told_apart({MovePlane{a, {}}, MovePlane{a, turned}, MovePlane{a, shifted}, MovePlane{a, anchored}});
  RoleVotes votes{};
  votes[2] = 0.25F;
  expect_told_apart({ClassifyPlane{a}, ClassifyPlane{a, SurfaceRole::wall},
                     ClassifyPlane{a, SurfaceRole::door}, ClassifyPlane{a, SurfaceRole::wall, votes}});
  MappedPlane wall, voted, moved;
  wall.role = SurfaceRole::wall;
  voted.votes = votes;
  moved.plane = turned;
  expect_told_apart({AddPlane{a, {}}, AddPlane{a, wall}, AddPlane{a, voted}, AddPlane{a, moved}});
}

}  // namespace
}  // namespace vsgraphs
