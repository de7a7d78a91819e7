// Free space in an archive.
#include <gtest/gtest.h>

#include "core/base/test_archive.h"
#include "core/scene/space/free_space.h"

namespace vsgraphs {
namespace {

constexpr ArchiveKind kind{"TESTFREE", 1, "free space"};

std::shared_ptr<const DepthGrid> wall_at(float depth_m) {
  DepthGrid grid;
  grid.columns = 20;
  grid.rows = 15;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.columns; ++c) {
      const float x = 0.1F * static_cast<float>(c - 10), y = 0.1F * static_cast<float>(r - 7);
      grid.samples.push_back({{x, y, depth_m}, -Eigen::Vector3f::UnitZ()});
    }
  }
  return std::make_shared<const DepthGrid>(std::move(grid));
}

Se3 at(double x) { return {Eigen::Matrix3d::Identity(), {x, 0, 0}}; }

FreeSpace some_space() {
  FreeSpaceOptions options;
  options.voxel_m = 0.05;
  FreeSpace space(options);
  for (std::uint32_t k = 0; k < 6; ++k)
    space.integrate({k, 0}, wall_at(2.0F + 0.3F * static_cast<float>(k)), at(0.5 * k));
  space.remove({2, 0});
  return space;
}

Bytes bytes_of(const FreeSpace& space) {
  ArchiveWriter archive(kind);
  archive.add("space", space);
  return test::joined(archive.finish());
}

FreeSpace space_of(const Bytes& bytes) {
  ArchiveReader archive("FILE", bytes, kind);
  archive.load_shared<DepthGrid>();
  FreeSpace space(FreeSpaceOptions{});
  archive.read("space", space);
  return space;
}

void expect_same_voxels(const FreeSpace& a, const FreeSpace& b) {
  ASSERT_EQ(a.voxels().blocks().size(), b.voxels().blocks().size());
  for (const VoxelBlocks::Block& block : a.voxels().blocks()) {
    const VoxelBlocks::Block* other = b.voxels().find(block.origin);
    ASSERT_NE(other, nullptr);
    for (std::size_t i = 0; i < block.voxels.size(); ++i) {
      EXPECT_EQ(block.voxels[i].passes, other->voxels[i].passes);
      EXPECT_EQ(block.voxels[i].hits, other->voxels[i].hits);
    }
  }
}

TEST(FreeSpaceArchive, ComesBackAndGoesOnAlike) {
  FreeSpace space = some_space();
  FreeSpace back = space_of(bytes_of(space));
  EXPECT_GT(space.voxels().blocks().size(), 100U);
  expect_same_voxels(space, back);
  EXPECT_EQ(bytes_of(back), bytes_of(space));
  EXPECT_EQ(back.version(), space.version());
  for (FreeSpace* one : {&space, &back}) {
    one->remove({1, 0});
    one->integrate({9, 0}, wall_at(3.3F), at(-4));
    one->refresh(std::vector<KeyframePose>{{{3, 0}, at(1.7)}}, 5);
  }
  expect_same_voxels(space, back);
  EXPECT_EQ(bytes_of(back), bytes_of(space));
}

TEST(FreeSpaceArchive, BlocksThatOverlapAreAnError) {
  VoxelBlocks blocks;
  blocks.block({0, 0, 0});
  blocks.block({8, 0, 0});
  ArchiveWriter writer(kind);
  writer.add("blocks", blocks);
  Bytes all;
  for (const auto& part : writer.finish()) all.insert(all.end(), part.begin(), part.end());
  const ArchiveReader reader("FILE", all, kind);
  for (const int forged : {0, 9}) {  // twice the same; between two
    Bytes section(reader.section("blocks").begin(), reader.section("blocks").end());
    const std::size_t second = sizeof(std::uint64_t) + 3 * sizeof(int) + 512 * sizeof(Voxel);
    std::memcpy(section.data() + second, &forged, sizeof forged);
    ArchiveWriter writer_of_forged(kind);
    writer_of_forged.add_bytes("blocks", std::move(section));
    Bytes bytes;
    for (const auto& part : writer_of_forged.finish()) bytes.insert(bytes.end(), part.begin(), part.end());
    const ArchiveReader forged_reader("FILE", bytes, kind);
    VoxelBlocks read;
    EXPECT_THROW(forged_reader.read("blocks", read), InputError);
  }
}

}  // namespace
}  // namespace vsgraphs
