#include "core/scene/rooms/level_map.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

void set(VoxelBlocks& voxels, int x, double low_m, double high_m, Voxel value) {
  for (int z = static_cast<int>(std::lround(low_m * 10)); z < std::lround(high_m * 10); ++z) {
    const Eigen::Vector3i at(x, 0, z);
    VoxelBlocks::Block& block = voxels.block(at);
    const Eigen::Vector3i in = at - block.origin;
    block.at(in.x(), in.y(), in.z()) = value;
  }
}

constexpr Voxel free_voxel{10, 0}, occupied_voxel{0, 10};

CellState state_at(const LevelMap& map, int x) {
  return map.cells[static_cast<std::size_t>(map.frame.index_at({0.1 * x + 0.05, 0.05}))];
}

TEST(LevelMap, EyeLevelDecidesWhatIsOpen) {
  VoxelBlocks voxels;
  set(voxels, 0, 0.1, 2.0, free_voxel);
  set(voxels, 1, 0.1, 0.8, occupied_voxel);  // a table with free space above
  set(voxels, 1, 0.8, 2.0, free_voxel);
  set(voxels, 2, 0.1, 1.8, occupied_voxel);  // a cupboard
  set(voxels, 2, 1.8, 2.0, free_voxel);
  set(voxels, 3, 0.3, 1.0, free_voxel);  // seen by a camera that looks down
  set(voxels, 4, 2.1, 2.3, occupied_voxel);
  set(voxels, 4, 0.1, 2.0, free_voxel);
  const LevelMap map = build_level_map(voxels, 0.1, 0, {}, {});
  EXPECT_EQ(state_at(map, 0), CellState::open);
  EXPECT_EQ(state_at(map, 1), CellState::open);
  EXPECT_EQ(state_at(map, 2), CellState::blocked);
  EXPECT_EQ(state_at(map, 3), CellState::open);
  EXPECT_EQ(state_at(map, 6), CellState::unknown);
  EXPECT_EQ(map.columns[static_cast<std::size_t>(map.frame.index_at({0.45, 0.05}))].lintel_occupied, 2);
}

TEST(LevelMap, AStairwellIsNoGroundToStandOn) {
  VoxelBlocks voxels;
  set(voxels, 0, -1.0, 2.0, free_voxel);  // one looks down
  set(voxels, 1, -1.0, 2.0, free_voxel);
  set(voxels, 1, -0.1, 0.1, occupied_voxel);
  const LevelMap map = build_level_map(voxels, 0.1, 0, {}, {});
  EXPECT_EQ(state_at(map, 0), CellState::blocked);
  EXPECT_EQ(state_at(map, 1), CellState::open);
}

TEST(LevelMap, WallsBlockWhereTheyWereSeen) {
  VoxelBlocks voxels;
  for (int x = 0; x < 3; ++x) set(voxels, x, 0.1, 2.0, free_voxel);
  SceneFace wall{
      PlaneId{1, 0}, {}, {{0.05f, 0.05f, 1.0f}, {0.15f, 0.05f, 2.4f}}};  // the second one is a lintel
  const LevelMap map = build_level_map(voxels, 0.1, 0, std::vector{wall}, {});
  EXPECT_EQ(state_at(map, 0), CellState::blocked);
  EXPECT_EQ(state_at(map, 1), CellState::open);
}

TEST(LevelMap, OfVoxelsThereMayBeNone) {
  const LevelMap map = build_level_map({}, 0.1, 0, {}, {});
  EXPECT_EQ(map.frame.size(), 0);
  EXPECT_TRUE(map.cells.empty());
}

SceneFace ground(double height, double size_m) {
  SceneFace face{PlaneId{1, 0}, {Eigen::Vector3d::UnitZ(), {0, 0, height}, 0}, {}};
  for (double x = 0.05; x < size_m; x += 0.1)
    for (double y = 0.05; y < size_m; y += 0.1)
      face.points.push_back(Eigen::Vector3d(x, y, height).cast<float>());
  return face;
}

TEST(LevelMap, OfPiecesKilometresApartThereIsNone) {
  VoxelBlocks voxels;
  set(voxels, 0, 0.1, 2.0, free_voxel);
  const Eigen::Vector3i far(200000, 100000, 12);
  voxels.block(far).at(0, 0, 0) = free_voxel;
  const LevelMap map = build_level_map(voxels, 0.1, 0, {}, {});
  EXPECT_EQ(map.frame.size(), 0);
  EXPECT_TRUE(map.cells.empty());
}

TEST(LevelHeights, TablesAndLandingsAreNoStoreys) {
  const std::vector<SceneFace> grounds{ground(2.8, 3), ground(0.75, 1.2), ground(0, 4), ground(1.4, 1.5),
                                       ground(5.5, 0.6)};  // the last one is too small
  const std::vector<double> levels = level_heights(grounds, {});
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_NEAR(levels[0], 0, 1e-6);
  EXPECT_NEAR(levels[1], 2.8, 1e-6);
  EXPECT_TRUE(level_heights({}, {}).empty());
}

}  // namespace
}  // namespace vsgraphs
