// Grids of voxels that stand somewhere in a levelled frame, put together into one grid of that frame: of each voxel there, the
// voxel of the other grid in which its middle lies. Counts stay whole numbers and surfaces get no holes.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/se3.h"
#include "core/scene/space/voxel_blocks.h"

namespace vsgraphs {

// A block by its place; 21 bits per axis. Keys ascend by x, then y, then z.
using BlockKey = std::uint64_t;
BlockKey key_of(const Eigen::Vector3i& origin);
Eigen::Vector3i origin_of(BlockKey key);

bool is_identity(const Se3& pose);

// Blocks of the levelled frame in which something of the grid may lie, ascending; exactly its own where it stands as it is.
// About 0.2 us per block.
std::vector<BlockKey> covered_blocks(const VoxelBlocks& grid, const Se3& level_from_grid, double voxel_m);

// Adds what of the grid lies in the block. About 2 us; 0.3 us where the grid stands as it is.
void add_placed(const VoxelBlocks& grid, const Se3& level_from_grid, double voxel_m, VoxelBlocks::Block& sum);

}  // namespace vsgraphs
