#include "core/scene/space/voxel_blocks.h"

#include <algorithm>

namespace vsgraphs {
namespace {

constexpr std::size_t first_slots = 256;  // a power of two, as are all its successors

Eigen::Vector3i origin_of(const Eigen::Vector3i& voxel) {
  constexpr int mask = ~(VoxelBlocks::edge - 1);
  return {voxel.x() & mask, voxel.y() & mask, voxel.z() & mask};
}

std::uint64_t hash(const Eigen::Vector3i& origin) {
  const auto word = [](int i) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i >> 3)); };
  std::uint64_t h =
      word(origin.x()) * 73856093u ^ word(origin.y()) * 19349669u ^ word(origin.z()) * 83492791u;
  h *= 0x9e3779b97f4a7c15ULL;
  return h ^ (h >> 32);
}

}  // namespace

bool VoxelBlocks::Block::empty() const {
  return std::all_of(voxels.begin(), voxels.end(), [](const Voxel& v) { return v.empty(); });
}

VoxelBlocks::VoxelBlocks() : slots_(first_slots, -1) {}

std::size_t VoxelBlocks::slot_of(const Eigen::Vector3i& origin) const {
  std::size_t slot = hash(origin) & (slots_.size() - 1);
  while (slots_[slot] >= 0 && blocks_[static_cast<std::size_t>(slots_[slot])].origin != origin)
    slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

void VoxelBlocks::rehash(std::size_t slots) {
  slots_.assign(slots, -1);
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    slots_[slot_of(blocks_[i].origin)] = static_cast<std::int32_t>(i);
}

bool VoxelBlocks::restore() {
  std::size_t slots = first_slots;
  while (slots < 2 * blocks_.size()) slots *= 2;
  slots_.assign(slots, -1);
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const std::size_t slot = slot_of(blocks_[i].origin);
    if (slots_[slot] >= 0 || origin_of(blocks_[i].origin) != blocks_[i].origin) return false;
    slots_[slot] = static_cast<std::int32_t>(i);
  }
  return true;
}

VoxelBlocks::Block& VoxelBlocks::block(const Eigen::Vector3i& voxel) {
  const Eigen::Vector3i origin = origin_of(voxel);
  std::size_t slot = slot_of(origin);
  if (slots_[slot] < 0) {
    if (2 * (blocks_.size() + 1) > slots_.size()) {
      rehash(2 * slots_.size());
      slot = slot_of(origin);
    }
    slots_[slot] = static_cast<std::int32_t>(blocks_.size());
    blocks_.emplace_back().origin = origin;
  }
  return blocks_[static_cast<std::size_t>(slots_[slot])];
}

const VoxelBlocks::Block* VoxelBlocks::find(const Eigen::Vector3i& voxel) const {
  const std::int32_t index = slots_[slot_of(origin_of(voxel))];
  return index < 0 ? nullptr : &blocks_[static_cast<std::size_t>(index)];
}

Voxel VoxelBlocks::at(const Eigen::Vector3i& voxel) const {
  const Block* block = find(voxel);
  if (!block) return {};
  const Eigen::Vector3i in_block = voxel - block->origin;
  return block->at(in_block.x(), in_block.y(), in_block.z());
}

std::size_t VoxelBlocks::memory_bytes() const {
  return blocks_.size() * sizeof(Block) + slots_.capacity() * sizeof(std::int32_t);
}

void VoxelBlocks::drop_empty() {
  if (std::erase_if(blocks_, [](const Block& block) { return block.empty(); }) > 0) rehash(slots_.size());
}

}  // namespace vsgraphs
