// Kept free space in an archive, of this format and of those before.
#include <gtest/gtest.h>

#include "core/base/test_archive.h"
#include "core/scene/space/test_kept_space.h"

namespace vsgraphs {
namespace {

using test::difference;
using test::KeptMap;
using test::standing_at;

constexpr ArchiveKind kind{"TESTKEEP", 3, "free space"};

Bytes bytes_of(const SpaceKeeper& keeper) {
  ArchiveWriter archive(kind);
  keeper.save(archive, "free_space");
  return test::joined(archive.finish());
}

std::shared_ptr<SpaceKeeper> keeper_of(const Bytes& bytes) {
  ArchiveReader archive("FILE", bytes, kind);
  archive.load_shared<DepthGrid>();
  auto keeper = std::make_shared<SpaceKeeper>(FreeSpaceOptions{}, 4);
  keeper->load(archive, "free_space");
  return keeper;
}

class SpaceKeeperArchive : public ::testing::Test {
 protected:
  SpaceKeeperArchive() {
    kept_.add_walk(walk_, 0, 12);
    second_ = kept_.add_walk(walk_, 12, 24);
    kept_.up();
    kept_.catch_up();
    kept_.edit({RemoveKeyframe{{3, 0}, {2, 0}}});
    kept_.move_stretch(second_, Se3::exp((Vector6d() << 0.3, 0.1, 0, 0, 0, 0.05).finished()));
    kept_.catch_up();
  }

  test::TestWalk walk_ = test::walk_two_rooms(test::two_rooms());
  KeptMap kept_;
  KeyframeId second_;
};

TEST_F(SpaceKeeperArchive, ComesBackAndGoesOnAlike) {
  const auto back = keeper_of(bytes_of(*kept_.keeper));
  EXPECT_EQ(back->wrong_with(kept_.map), nullptr);
  EXPECT_EQ(difference(back->voxels(), kept_.keeper->voxels()), 0U);
  EXPECT_EQ(back->view().views.size(), kept_.keeper->view().views.size());
  EXPECT_EQ(bytes_of(*back), bytes_of(*kept_.keeper));
  KeptMap again = kept_;
  again.keeper = back;
  for (KeptMap* one : {&kept_, &again}) {
    one->move_stretch(second_, standing_at(0.2));
    one->add_walk(walk_, 24, 30);
    one->edit({RemoveKeyframe{{5, 0}, {2, 0}, true}});
    one->catch_up();
    EXPECT_GT(one->keeper->last_work().carved, 0);
  }
  EXPECT_EQ(difference(again.keeper->voxels(), kept_.keeper->voxels()), 0U);
  EXPECT_EQ(bytes_of(*again.keeper), bytes_of(*kept_.keeper));
}

TEST_F(SpaceKeeperArchive, AKeyframeThatWaitedIsNotLost) {
  kept_.add_walk(walk_, 24, 30);
  const auto back = keeper_of(bytes_of(*kept_.keeper));
  kept_.catch_up();
  back->catch_up(kept_.map, true);
  EXPECT_EQ(difference(back->voxels(), kept_.keeper->voxels()), 0U);
}

TEST_F(SpaceKeeperArchive, OneGridOfAnOlderFileGoesOnBeingOne) {
  const FreeSpace before = kept_.anew();
  ArchiveWriter older({kind.magic, 2, kind.what});
  older.add("free_space", before);
  const auto back = keeper_of(test::joined(older.finish()));
  EXPECT_EQ(back->wrong_with(kept_.map), nullptr);
  EXPECT_EQ(difference(back->voxels(), before.voxels()), 0U);
  back->catch_up(kept_.map, true);
  EXPECT_EQ(back->last_work().carved, 0);
  kept_.keeper = back;
  kept_.move_stretch(second_, standing_at(0.2));
  kept_.add_walk(walk_, 24, 30);
  kept_.catch_up();
  EXPECT_EQ(back->parts().size(), 2U);
  EXPECT_GT(test::share_near(back->voxels(), kept_.anew().voxels()), 0.99);
  EXPECT_GT(test::share_near(kept_.anew().voxels(), back->voxels()), 0.99);
}

TEST_F(SpaceKeeperArchive, OtherVoxelsAreGatheredAnew) {
  FreeSpaceOptions options;
  options.voxel_m = 0.05;
  kept_.keeper->use(options, 4);
  kept_.catch_up();
  kept_.depths.erase({3, 0});  // of which nothing is left
  EXPECT_EQ(difference(kept_.keeper->voxels(), kept_.anew().voxels()), 0U);
}

TEST_F(SpaceKeeperArchive, WhatCannotBeIsAnError) {
  Map other;
  EXPECT_NE(kept_.keeper->wrong_with(other), nullptr);
  std::map<KeyframeId, SpaceKeeper::Part> parts = kept_.keeper->parts();
  const auto read = [&] {
    ArchiveWriter archive(kind);
    archive.add("free_space", FreeSpaceOptions{}, parts);
    return keeper_of(test::joined(archive.finish()));
  };
  EXPECT_NO_THROW(read());
  parts.begin()->second.level_from_grid = standing_at(1e9);
  EXPECT_THROW(read(), InputError);
  parts = kept_.keeper->parts();
  FreeSpaceOptions fine;
  fine.voxel_m = 0.05;
  parts.begin()->second.space = CopyOnWrite(FreeSpace(fine));
  EXPECT_THROW(read(), InputError);
}

}  // namespace
}  // namespace vsgraphs
