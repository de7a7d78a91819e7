// Sparse storage of voxels: blocks of 8 x 8 x 8 found through a hash table with open addressing.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "core/base/fields.h"

namespace vsgraphs {

struct Voxel {
  std::uint32_t passes = 0;  // rays that went through
  std::uint32_t hits = 0;    // rays that ended here

  bool empty() const { return passes == 0 && hits == 0; }
  // Rays graze a wall on their way to its next piece, so a surface keeps being a surface when a few rays per hit pass.
  bool occupied() const { return hits >= 2 && 4 * hits >= passes; }
  bool free() const { return passes >= 2 && !occupied(); }
};
template <FieldsOf<Voxel> T>
void visit_fields(T& v, auto& field) {
  auto& [passes, hits] = v;
  field(passes, hits);
}

class VoxelBlocks {
 public:
  static constexpr int edge = 8;

  struct Block {
    Eigen::Vector3i origin;  // of its first voxel, in voxels
    std::array<Voxel, edge * edge * edge> voxels;
    Voxel& at(int x, int y, int z) { return voxels[index(x, y, z)]; }
    const Voxel& at(int x, int y, int z) const { return voxels[index(x, y, z)]; }
    static std::size_t index(int x, int y, int z) {
      return static_cast<std::size_t>((z * edge + y) * edge + x);
    }
    bool empty() const;
    template <FieldsOf<Block> T>
    friend void visit_fields(T& v, auto& field) {
      field(v.origin, v.voxels);
    }
  };

  VoxelBlocks();

  // The block that holds a voxel; made where there is none. References stay valid until drop_empty().
  Block& block(const Eigen::Vector3i& voxel);
  const Block* find(const Eigen::Vector3i& voxel) const;
  Voxel at(const Eigen::Vector3i& voxel) const;
  // In the order they were made.
  const std::deque<Block>& blocks() const { return blocks_; }
  std::size_t memory_bytes() const;
  void drop_empty();

  // Blocks in the order they were made; the hash table follows from them.
  template <FieldsOf<VoxelBlocks> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.blocks_);
    if constexpr (std::remove_reference_t<decltype(field)>::reads)
      field.require(v.restore(), "voxels that overlap");
  }

 private:
  // Makes the hash table of blocks that were read; false if two are one or one is out of step.
  bool restore();
  std::size_t slot_of(const Eigen::Vector3i& origin) const;
  void rehash(std::size_t slots);

  std::deque<Block> blocks_;
  std::vector<std::int32_t> slots_;  // index of a block, or -1
};

}  // namespace vsgraphs
