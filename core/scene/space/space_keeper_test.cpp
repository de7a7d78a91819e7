#include "core/scene/space/space_keeper.h"

#include <gtest/gtest.h>

#include "core/map/test_depth_row.h"
#include "core/scene/space/test_kept_space.h"

namespace vsgraphs {
namespace {

using test::difference;
using test::KeptMap;
using test::share_near;
using test::standing_at;

Se3 turned(double degrees, const Eigen::Vector3d& by) {
  return {so3_exp({0, 0, degrees * std::numbers::pi / 180}), by};
}

class SpaceKeeperTest : public ::testing::Test {
 protected:
  // Two rooms, a stretch each.
  void walk_through() {
    const std::size_t n = walk_.poses().size();
    first_ = kept_.add_walk(walk_, 0, n / 2);
    second_ = kept_.add_walk(walk_, n / 2, n);
    kept_.up();
    kept_.catch_up();
  }
  const SpaceKeeper& keeper() const { return *kept_.keeper; }

  test::TestWalk walk_ = test::walk_two_rooms(test::two_rooms());
  KeptMap kept_;
  KeyframeId first_, second_;
};

TEST_F(SpaceKeeperTest, IsOneGridWhileNothingMoves) {
  walk_through();
  EXPECT_EQ(keeper().parts().size(), 2U);
  EXPECT_EQ(difference(keeper().voxels(), kept_.anew().voxels()), 0U);
  EXPECT_EQ(keeper().view().views.size(), walk_.poses().size());
  kept_.catch_up();
  EXPECT_EQ(keeper().last_work().carved + keeper().last_work().checked + keeper().last_work().summed, 0);
}

TEST_F(SpaceKeeperTest, WaitsForTheWayUp) {
  kept_.add(standing_at(0), test::depth_row());
  kept_.catch_up();
  EXPECT_TRUE(keeper().voxels().blocks().empty());
  kept_.up();
  kept_.catch_up();
  EXPECT_FALSE(keeper().voxels().blocks().empty());
}

TEST_F(SpaceKeeperTest, AStretchThatMovesIsPutElsewhereAndCarvedNotAgain) {
  walk_through();
  const Se3 correction = turned(2, {0.32, -0.15, 0.06});
  kept_.move_stretch(second_, correction);
  kept_.catch_up(false);
  EXPECT_EQ(keeper().last_work().carved, 0);
  const VoxelBlocks anew = kept_.anew().voxels();
  EXPECT_GT(difference(keeper().voxels(), anew), 0U) << "carved again all the same?";
  EXPECT_GT(share_near(anew, keeper().voxels()), 0.99);
  EXPECT_GT(share_near(keeper().voxels(), anew), 0.99);
  const FoundStructure found =
      recognise_structure(keeper().view(), walk_.faces(), {}, {});  // walls as before: all within 0.4 m
  EXPECT_EQ(found.rooms.size(), 2U);

  kept_.move_stretch(second_, correction.inverse());
  kept_.catch_up(false);
  EXPECT_EQ(keeper().last_work().carved, 0);
  EXPECT_EQ(difference(keeper().voxels(), kept_.anew().voxels()), 0U);
}

TEST_F(SpaceKeeperTest, AWholeNumberOfVoxelsAwayCountsAreTheSame) {
  walk_through();
  const SpaceKeeper before = keeper();
  for (const KeyframeId stretch : {first_, second_}) kept_.move_stretch(stretch, standing_at(0.7, -0.3, 1.1));
  kept_.catch_up(false);
  for (const VoxelBlocks::Block& block : before.voxels().blocks())
    for (int i = 0; i < 512; ++i) {
      const Eigen::Vector3i in_block(i % 8, i / 8 % 8, i / 64);
      const Voxel was = block.voxels[static_cast<std::size_t>(i)],
                  is = keeper().voxels().at(block.origin + in_block + Eigen::Vector3i(7, -3, 11));
      ASSERT_EQ(is.passes, was.passes);
      ASSERT_EQ(is.hits, was.hits);
    }
}

TEST_F(SpaceKeeperTest, AnotherWayUpCarvesNothingAgain) {
  walk_through();
  kept_.edit({vsgraphs::SetUp{Eigen::Vector3d(0.02, -0.01, 1).normalized()}});
  kept_.catch_up(false);
  EXPECT_EQ(keeper().last_work().carved, 0);
  EXPECT_GT(share_near(kept_.anew().voxels(), keeper().voxels()), 0.99);
}

TEST_F(SpaceKeeperTest, WhatMovesWithinItsStretchIsCarvedAgainAFewAtATime) {
  walk_through();
  std::vector<EditOperation> moves;
  for (std::uint32_t k = 3; k < 9; ++k)
    moves.emplace_back(MoveKeyframe{
        {k, 0}, standing_at(0, 0.04 + 0.01 * k) * kept_.map.keyframes().find({k, 0})->world_from_camera});
  kept_.edit(std::move(moves));
  for (const int carved : {4, 2, 0}) {
    kept_.catch_up(false);
    EXPECT_EQ(keeper().last_work().carved, carved);
  }
  EXPECT_EQ(difference(keeper().voxels(), kept_.anew().voxels()), 0U);
}

TEST_F(SpaceKeeperTest, WhatMovesWithinAMovedStretchIsCarvedWhereItStands) {
  walk_through();
  kept_.move_stretch(second_, standing_at(0.5, 0.2));
  const auto k = second_.index + 3;
  const Keyframe* moved = kept_.map.keyframes().find({k, 0});
  kept_.edit({MoveKeyframe{{k, 0}, standing_at(0, 0.1) * moved->world_from_camera}});
  kept_.catch_up();
  EXPECT_EQ(keeper().last_work().carved, 1);
  EXPECT_EQ(difference(keeper().voxels(), kept_.anew().voxels()), 0U) << "whole voxels";
}

TEST_F(SpaceKeeperTest, WhatACulledKeyframeCarvedStaysUnlessOthersReplaceIt) {
  walk_through();
  kept_.edit({RemoveKeyframe{{3, 0}, {2, 0}}});
  kept_.catch_up();
  EXPECT_EQ(difference(keeper().voxels(), kept_.anew().voxels()), 0U);
  kept_.edit({RemoveKeyframe{{4, 0}, {2, 0}, true}});
  kept_.catch_up();
  EXPECT_EQ(difference(keeper().voxels(), kept_.anew().voxels()), 0U);
  EXPECT_EQ(keeper().view().views.size(), walk_.poses().size() - 1);
}

TEST_F(SpaceKeeperTest, CulledKeyframesLetGoOfTheirDepthInAnotherStretch) {
  const std::size_t n = walk_.poses().size();
  first_ = kept_.add_walk(walk_, 0, n / 2);
  kept_.up();
  kept_.edit({RemoveKeyframe{{3, 0}, {2, 0}}});
  kept_.catch_up();
  EXPECT_EQ(kept_.keeper->parts().at(first_).space->views().size(), n / 2 - 1) << "gone before it was carved";
  kept_.edit({RemoveKeyframe{{4, 0}, {2, 0}}});
  kept_.catch_up();
  const auto depth_of = [&](std::uint32_t k) {
    return keeper().parts().at(first_).space->views().at({k, 0}).depth;
  };
  EXPECT_NE(depth_of(4), nullptr);
  second_ = kept_.add_walk(walk_, n / 2, n);
  kept_.catch_up();
  EXPECT_EQ(depth_of(4), nullptr);
  EXPECT_NE(depth_of(5), nullptr);
  kept_.edit({RemoveKeyframe{{5, 0}, {2, 0}}});
  kept_.catch_up();
  EXPECT_EQ(depth_of(5), nullptr);

  // What it carved goes along with its stretch.
  kept_.move_stretch(first_, standing_at(-0.4));
  kept_.catch_up();
  EXPECT_EQ(keeper().last_work().carved, 0);
  kept_.depths.erase({3, 0});
  EXPECT_EQ(difference(keeper().voxels(), kept_.anew().voxels()), 0U);
}

TEST_F(SpaceKeeperTest, ACopyGoesItsOwnWay) {
  walk_through();
  const KeptMap slept = kept_;
  const auto asleep = std::dynamic_pointer_cast<SpaceKeeper>(keeper().copy());
  kept_.move_stretch(second_, standing_at(0.4));
  kept_.edit({RemoveKeyframe{{4, 0}, {2, 0}, true}});
  kept_.catch_up();
  EXPECT_EQ(difference(keeper().voxels(), kept_.anew().voxels()), 0U);
  EXPECT_EQ(difference(asleep->voxels(), slept.anew().voxels()), 0U);
  const auto woken = std::dynamic_pointer_cast<SpaceKeeper>(asleep->copy());
  EXPECT_EQ(&woken->voxels(), &asleep->voxels()) << "costs nothing until it changes";
}

}  // namespace
}  // namespace vsgraphs
