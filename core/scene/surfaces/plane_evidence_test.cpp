#include "core/scene/surfaces/plane_evidence.h"

#include <gtest/gtest.h>

#include "core/scene/surfaces/test_surfaces.h"

namespace vsgraphs {
namespace {

using namespace test;

// A board of 1 m at y = 2, a wall 1 m behind it, seen from the origin.
class PlaneEvidenceTest : public ::testing::Test {
 protected:
  void look(PlaneEvidence& evidence, const Se3& pose) const {
    evidence.integrate(board, view(world, pose), pose, Camera{}.depth_noise);
  }
  World world = World().sheet({-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}).sheet({-4, 3, -4}, {8, 0, 0}, {0, 0, 8});
  AnchoredPlane board = plane_at({0, 2, 0}, -Eigen::Vector3d::UnitY());
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Se3 ahead = looking({0, 0, 0}, {0, 2, 0});
};

TEST_F(PlaneEvidenceTest, RaysEndOnItOrPassBesideIt) {
  PlaneEvidence evidence(frame_of(board, up));
  look(evidence, ahead);
  EXPECT_TRUE(evidence.solid_at({0.25, 2, 0.25}));
  EXPECT_FALSE(evidence.solid_at({0.75, 2, 0.25}));
  const Eigen::Vector2d beside = evidence.frame().coordinates({0.75, 2, 0.25});
  EXPECT_TRUE(evidence.open(cell_at(beside.x(), beside.y(), PlaneEvidence::cell_m)));
}

TEST_F(PlaneEvidenceTest, WhatStandsBeforeItSaysNothingOfIt) {
  world.sheet({-0.2, 1, -0.2}, {0.4, 0, 0}, {0, 0, 0.4});
  PlaneEvidence evidence(frame_of(board, up));
  look(evidence, ahead);
  const Eigen::Vector2d hidden = evidence.frame().coordinates({0.05, 2, 0.05});
  const Cell cell = cell_at(hidden.x(), hidden.y(), PlaneEvidence::cell_m);
  EXPECT_FALSE(evidence.solid(cell));
  EXPECT_FALSE(evidence.open(cell));
}

TEST_F(PlaneEvidenceTest, OnlyTheSideItFacesCounts) {
  PlaneEvidence evidence(frame_of(board, up));
  look(evidence, looking({0, 2.9, 0}, {0, 2, 0}));
  EXPECT_TRUE(evidence.cells().empty());
}

TEST_F(PlaneEvidenceTest, FarBeyondItsEdgeNothingIsKept) {
  PlaneEvidence evidence(frame_of(board, up));
  look(evidence, looking({0, -2, 0}, {0, 2, 0}));
  const Eigen::Vector2d far_off = evidence.frame().coordinates({2.0, 2, 0});
  EXPECT_EQ(evidence.cells().at(cell_at(far_off.x(), far_off.y(), PlaneEvidence::cell_m)).through, 0);
}

TEST_F(PlaneEvidenceTest, WhatLiesInLineWithItElsewhereIsAnotherSurface) {
  world.sheet({-0.5, 2, 1.2}, {1, 0, 0}, {0, 0, 1});
  const Se3 higher = looking({0, 0, 1.7}, {0, 2, 1.7});
  const PlaneFrame frame = frame_of(board, up);
  PlaneEvidence evidence(frame);
  evidence.integrate(board, view(world, higher), higher, Camera{}.depth_noise, false);
  EXPECT_TRUE(evidence.cells().empty()) << "it has not been seen yet";
  look(evidence, ahead);
  for (int i = 0; i < 3; ++i)
    evidence.integrate(board, view(world, higher), higher, Camera{}.depth_noise, false);
  EXPECT_TRUE(evidence.solid_at({0.25, 2, 0.25}));
  EXPECT_FALSE(evidence.solid_at({0.25, 2, 1.75}));
  const Eigen::Vector2d between = frame.coordinates({0.05, 2, 1.0});
  EXPECT_TRUE(evidence.open(cell_at(between.x(), between.y(), PlaneEvidence::cell_m)));
  evidence.integrate(board, view(world, higher), higher, Camera{}.depth_noise, true);
  EXPECT_TRUE(evidence.solid_at({0.25, 2, 1.75})) << "unless a keyframe found them to be one";
}

TEST_F(PlaneEvidenceTest, ADoorThatStoodOpenAndIsShutIsAsItWasSeenMoreOften) {
  PlaneEvidence evidence(frame_of(board, up));
  World open;
  open.sheets = {world.sheets[1]};
  look(evidence, ahead);
  look(evidence, ahead);
  EXPECT_TRUE(evidence.solid_at({0.25, 2, 0.25}));
  for (int i = 0; i < 5; ++i) evidence.integrate(board, view(open, ahead), ahead, Camera{}.depth_noise);
  EXPECT_FALSE(evidence.solid_at({0.25, 2, 0.25}));
}

TEST_F(PlaneEvidenceTest, OfAMergedPlaneIsTakenOverInItsPlace) {
  const AnchoredPlane elsewhere = board.anchored_at({0.7, 2, 0.2});
  PlaneEvidence whole(frame_of(board, up)), kept(frame_of(board.anchored_at({0, 2, 0}), up)),
      gone(frame_of(elsewhere, up));
  look(gone, ahead);
  look(whole, ahead);
  kept.add(gone);
  for (double x = -0.35; x < 0.4; x += 0.1) {
    for (double z = -0.35; z < 0.4; z += 0.1) EXPECT_TRUE(kept.solid_at({x, 2, z})) << x << ' ' << z;
  }
  EXPECT_FALSE(kept.solid_at({0.8, 2, 0}));
}

TEST(CellGridTest, GrowsToAllSidesAndKeepsWhatItHas) {
  CellGrid<int> grid;
  EXPECT_TRUE(grid.empty());
  EXPECT_EQ(grid.at({5, 5}), 0);
  const std::vector<Cell> cells = {{0, 0}, {50, 0}, {-40, 3}, {7, -60}, {7, 90}, {-300, -300}};
  for (std::size_t i = 0; i < cells.size(); ++i) grid[cells[i]] = static_cast<int>(i) + 1;
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(grid.at(cells[i]), static_cast<int>(i) + 1);
  int sum = 0;
  for (int t = grid.min_t(); t < grid.end_t(); ++t)
    for (int s = grid.min_s(); s < grid.end_s(); ++s) sum += grid.at({s, t});
  EXPECT_EQ(sum, 21);
}

TEST(CellGridTest, CellsBelowZeroAreAsLargeAsThoseAbove) {
  EXPECT_EQ(cell_at(-0.01, 0.01, 0.1), (Cell{-1, 0}));
  EXPECT_EQ(cell_at(-0.11, 0.19, 0.1), (Cell{-2, 1}));
}

TEST(PlaneFrameTest, OfAWallTPointsUpAndSIsLevel) {
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, 0.2, 1).normalized();
  const PlaneFrame frame = frame_of(plane_at({3, 1, 2}, up.unitOrthogonal()), up);
  EXPECT_NEAR(frame.t.dot(up), 1, 1e-9);
  EXPECT_NEAR(frame.s.dot(up), 0, 1e-9);
  EXPECT_EQ(frame.coordinates({3, 1, 2}).norm(), 0);
  EXPECT_TRUE(frame.point(1, 2).isApprox(frame.origin + frame.s + 2 * frame.t));
  const PlaneFrame level = frame_of(plane_at({0, 0, 0}, up), up);
  EXPECT_NEAR(level.s.dot(up), 0, 1e-9);
  EXPECT_NEAR(level.t.dot(up), 0, 1e-9);
}

TEST(PlaneExtentTest, LeavesOutWhatLiesHalfAKilometreOff) {
  PlaneExtent extent(PlaneFrame{});
  extent.add({1, 1, 0});
  extent.add({90000, 80000, 0});
  EXPECT_NEAR(extent.area_m2(), 0.01, 1e-9);
  EXPECT_LT(extent.cells().memory_bytes(), 10000U);
}

TEST(PlaneExtentTest, KnowsWhatIsNearAndHowMuchWasSeen) {
  PlaneExtent extent(frame_of(plane_at({0, 0, 0}, {0, 0, 1}), {}));
  EXPECT_FALSE(extent.near({0, 0, 0}, 5));
  for (double x = 0.05; x < 1; x += 0.05)
    for (double y = 0.05; y < 2; y += 0.05) extent.add({x, y, 0});
  EXPECT_NEAR(extent.area_m2(), 2, 0.05);
  EXPECT_TRUE(extent.centre().isApprox(Eigen::Vector3d(0.5, 1, 0), 0.1));
  EXPECT_TRUE(extent.near({1.25, 1, 0}, 0.3));
  EXPECT_FALSE(extent.near({1.45, 1, 0}, 0.3));
  EXPECT_DOUBLE_EQ(extent.share_near({{0.5, 1, 0}, {5, 1, 0}}, 0.3), 0.5);
  EXPECT_EQ(extent.share_near({}, 0.3), 0);
}

}  // namespace
}  // namespace vsgraphs
