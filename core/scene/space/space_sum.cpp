#include "core/scene/space/space_sum.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vsgraphs {
namespace {

constexpr int edge = VoxelBlocks::edge;
constexpr int edge_bits = 3;
static_assert(1 << edge_bits == edge);
constexpr int key_bits = 21;
constexpr std::int64_t key_bias = std::int64_t{1} << (key_bits - 1);
constexpr std::uint64_t key_mask = (std::uint64_t{1} << key_bits) - 1;

void add(const VoxelBlocks::Block& block, VoxelBlocks::Block& sum) {
  for (std::size_t i = 0; i < sum.voxels.size(); ++i) {
    sum.voxels[i].passes += block.voxels[i].passes;
    sum.voxels[i].hits += block.voxels[i].hits;
  }
}

// Numbers with 20 bits behind the point: their floor is a shift, the same on every processor.
using Fixed = Eigen::Matrix<std::int64_t, 3, 1>;
constexpr int fixed_bits = 20;
Fixed fixed(const Eigen::Vector3d& v) {
  return (v * (1 << fixed_bits)).array().round().cast<std::int64_t>().matrix();
}

// The grid's blocks around a place, at hand without a search.
class Neighbourhood {
 public:
  static constexpr int reach = 3;  // a block turned about its middle spans 15 voxels: at most 3 blocks

  Neighbourhood(const VoxelBlocks& grid, const Eigen::Vector3i& lowest_voxel) {
    for (int a = 0; a < 3; ++a) origin_[a] = lowest_voxel[a] & ~(edge - 1);
    for (int z = 0; z < reach; ++z)
      for (int y = 0; y < reach; ++y)
        for (int x = 0; x < reach; ++x) {
          const VoxelBlocks::Block* block = grid.find(origin_ + edge * Eigen::Vector3i(x, y, z));
          blocks_[index(x, y, z)] = block;
          any_ = any_ || block;
        }
  }
  bool any() const { return any_; }
  const Eigen::Vector3i& origin() const { return origin_; }
  // Counted from the origin; nullptr where nothing is known.
  const Voxel* at(int x, int y, int z) const {
    const VoxelBlocks::Block* block = blocks_[index(x >> edge_bits, y >> edge_bits, z >> edge_bits)];
    return block ? &block->at(x & (edge - 1), y & (edge - 1), z & (edge - 1)) : nullptr;
  }

 private:
  static std::size_t index(int x, int y, int z) {
    return static_cast<std::size_t>((z * reach + y) * reach + x);
  }
  Eigen::Vector3i origin_;
  std::array<const VoxelBlocks::Block*, std::size_t{reach} * reach * reach> blocks_{};
  bool any_ = false;
};

// Half of what a block turned like this spans along each axis, in voxels.
Eigen::Vector3d half_span(const Eigen::Matrix3d& rotation) {
  return 0.5 * edge * rotation.cwiseAbs().rowwise().sum();
}

}  // namespace

BlockKey key_of(const Eigen::Vector3i& origin) {
  BlockKey key = 0;
  for (int a = 0; a < 3; ++a)
    key = key << key_bits | (static_cast<std::uint64_t>((origin[a] >> edge_bits) + key_bias) & key_mask);
  return key;
}

Eigen::Vector3i origin_of(BlockKey key) {
  Eigen::Vector3i origin;
  for (int a = 2; a >= 0; --a, key >>= key_bits)
    origin[a] = static_cast<int>((static_cast<std::int64_t>(key & key_mask) - key_bias) * edge);
  return origin;
}

bool is_identity(const Se3& pose) {
  return pose.rotation() == Eigen::Matrix3d::Identity() && pose.translation() == Eigen::Vector3d::Zero();
}

std::vector<BlockKey> covered_blocks(const VoxelBlocks& grid, const Se3& level_from_grid, double voxel_m) {
  std::vector<BlockKey> keys;
  const bool in_place = is_identity(level_from_grid);
  const Eigen::Vector3d half = half_span(level_from_grid.rotation());
  for (const VoxelBlocks::Block& block : grid.blocks()) {
    if (block.empty()) continue;
    if (in_place) {
      keys.push_back(key_of(block.origin));
      continue;
    }
    const Eigen::Vector3d middle =
        level_from_grid.rotation() * (block.origin.cast<double>().array() + 0.5 * edge).matrix() +
        level_from_grid.translation() / voxel_m;
    const Eigen::Vector3i low = ((middle - half) / edge).array().floor().cast<int>(),
                          high = ((middle + half) / edge).array().floor().cast<int>();
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z) keys.push_back(key_of(edge * Eigen::Vector3i(x, y, z)));
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

void add_placed(const VoxelBlocks& grid, const Se3& level_from_grid, double voxel_m,
                VoxelBlocks::Block& sum) {
  if (is_identity(level_from_grid)) {
    if (const VoxelBlocks::Block* block = grid.find(sum.origin)) add(*block, sum);
    return;
  }
  const Se3 grid_from_level = level_from_grid.inverse();
  const Eigen::Matrix3d& turn = grid_from_level.rotation();
  const Eigen::Vector3d first =
      turn * (sum.origin.cast<double>().array() + 0.5).matrix() + grid_from_level.translation() / voxel_m;
  const Eigen::Vector3d middle = first + turn * Eigen::Vector3d::Constant(0.5 * (edge - 1));
  const Neighbourhood around(grid, (middle - half_span(turn)).array().floor().cast<int>().matrix());
  if (!around.any()) return;
  const Fixed start = fixed(first - around.origin().cast<double>());
  const Fixed along_x = fixed(turn.col(0)), along_y = fixed(turn.col(1)), along_z = fixed(turn.col(2));
  std::size_t i = 0;
  for (int z = 0; z < edge; ++z)
    for (int y = 0; y < edge; ++y) {
      Fixed at = start + z * along_z + y * along_y;
      for (int x = 0; x < edge; ++x, ++i, at += along_x) {
        const Voxel* voxel =
            around.at(static_cast<int>(at.x() >> fixed_bits), static_cast<int>(at.y() >> fixed_bits),
                      static_cast<int>(at.z() >> fixed_bits));
        if (!voxel) continue;
        sum.voxels[i].passes += voxel->passes;
        sum.voxels[i].hits += voxel->hits;
      }
    }
}

}  // namespace vsgraphs
