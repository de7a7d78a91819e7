// Free space that cannot be. Nobody who looks makes it: it comes from files that somebody changed.
#include "core/scene/space/free_space_checks.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/test_archive.h"
#include "core/map/test_depth_row.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

constexpr ArchiveKind kind{"TESTFREE", 1, "free space"};

class FreeSpaceChecks : public testing::Test {
 protected:
  FreeSpaceChecks() {
    for (int i = 0; i < 2; ++i) {
      Keyframe keyframe = test::keyframe_seeing(Camera{}, test::standing_at(i), test::point_grid(4, 4));
      ids_.push_back(test::add_keyframe(map_, keyframe));
      space_.integrate(ids_.back(), test::depth_row(), test::standing_at(i));
    }
  }
  // What is wrong with free space when it comes back from an archive: as such, or put together from its fields.
  template <typename... Parts>
  std::string read_back(const Parts&... parts) const {
    ArchiveWriter writer(kind);
    writer.add("space", parts...);
    const Bytes bytes = test::joined(writer.finish());
    ArchiveReader archive("FILE", bytes, kind);
    archive.load_shared<DepthGrid>();
    FreeSpace back(FreeSpaceOptions{});
    archive.read("space", back);
    const Wrong wrong = wrong_with_free_space(back, map_);
    return wrong ? wrong : "";
  }
  std::string with(const FreeSpaceOptions& options, const VoxelBlocks& blocks) const {
    return read_back(options, blocks, space_.views(), space_.version());
  }
  // A view of one sample, from somewhere.
  std::string seen(const Se3& from, const Eigen::Vector3f& point) const {
    DepthGrid grid;
    grid.columns = grid.rows = 1;
    grid.samples = {{point, Eigen::Vector3f::Zero()}};
    const std::map<KeyframeId, FreeSpace::View> views{
        {ids_[0], {std::make_shared<const DepthGrid>(grid), from}}};
    return read_back(FreeSpaceOptions{}, VoxelBlocks{}, views, space_.version());
  }

  Map map_;
  std::vector<KeyframeId> ids_;
  FreeSpace space_{FreeSpaceOptions{}};
};

TEST_F(FreeSpaceChecks, WhatWasCarvedPasses) {
  EXPECT_EQ(read_back(space_), "");
  EXPECT_EQ(read_back(FreeSpace(FreeSpaceOptions{})), "");
  // Carved anew far from where it was: what it leaves there is empty.
  space_.refresh(std::vector<KeyframePose>{{ids_[1], test::standing_at(500)}}, 5);
  EXPECT_EQ(read_back(space_), "");
}

TEST_F(FreeSpaceChecks, ItsViewsAreOfKeyframes) {
  space_.integrate({99, 0}, test::depth_row(), Se3{});
  EXPECT_EQ(read_back(space_), "free space seen by a keyframe that does not exist");
}

TEST_F(FreeSpaceChecks, NobodySeesFromNowhere) {
  EXPECT_EQ(seen(Se3{}, {0, 0, 1}), "");
  for (const double odd : {std::numeric_limits<double>::infinity(), 1e30, 1e9})
    EXPECT_EQ(seen(Se3{}, {0, static_cast<float>(odd), 1}), "free space seen from nowhere");
  for (const double odd : {1e300, -1e9})
    EXPECT_EQ(seen(test::standing_at(odd), {0, 0, 1}), "free space seen from nowhere");
  EXPECT_EQ(seen(Se3{}, {0, std::numeric_limits<float>::quiet_NaN(), 1}), "free space seen from nowhere");
}

TEST_F(FreeSpaceChecks, NothingIsKnownOfWhereNobodyLooked) {
  for (const int far : {4000, -1000000, 1 << 30}) {
    VoxelBlocks blocks = space_.voxels();
    blocks.block({0, far, 0}).at(0, 0, 0).passes = 3;
    EXPECT_EQ(with(space_.options(), blocks), "free space where nobody looked") << far;
  }
}

TEST_F(FreeSpaceChecks, VoxelsHaveASize) {
  for (const double size : {0.01, 5.0}) {
    FreeSpaceOptions options;
    options.voxel_m = size;
    EXPECT_EQ(with(options, VoxelBlocks{}), "free space of no resolution");
  }
}

}  // namespace
}  // namespace vsgraphs
