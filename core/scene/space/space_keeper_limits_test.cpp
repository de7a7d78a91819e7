// How much the keeper of free space takes in, and what that costs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_depth_row.h"
#include "core/scene/space/test_kept_space.h"

namespace vsgraphs {
namespace {

using test::KeptMap;
using test::standing_at;

TEST(SpaceKeeperLimits, WhatDoesNotFitIsLeftOutOnceAndSaidOnce) {
  const test::TestWalk walk = test::walk_two_rooms(test::two_rooms());
  KeptMap some;
  some.add_walk(walk, 0, 8);
  some.up();
  some.catch_up();
  FreeSpaceOptions options;
  options.max_blocks = static_cast<int>(some.keeper->voxels().blocks().size());
  KeptMap kept(options);
  kept.add_walk(walk, 0, 4);
  kept.up();
  kept.catch_up();
  EXPECT_EQ(kept.keeper->warning(), "");
  kept.add_walk(walk, 4, 20);
  kept.catch_up();
  const std::string warning = kept.keeper->warning();
  EXPECT_THAT(warning, testing::HasSubstr("max_blocks (" + std::to_string(options.max_blocks) + ")"));
  EXPECT_GT(kept.keeper->last_work().carved, 0);
  const std::size_t views = kept.keeper->view().views.size();
  EXPECT_LT(views, 20U);
  kept.catch_up();
  EXPECT_EQ(kept.keeper->last_work().carved, 0);
  EXPECT_EQ(kept.keeper->view().views.size(), views) << "tried again";
  EXPECT_EQ(kept.keeper->warning(), warning);
  // Room is made by what is taken out; what came meanwhile stays out.
  std::vector<EditOperation> removals;
  for (std::uint32_t k = 1; k < views; ++k) removals.emplace_back(RemoveKeyframe{{k, 0}, {0, 0}, true});
  kept.edit(std::move(removals));
  kept.catch_up();
  kept.add(walk.poses()[20].level_from_camera, walk.depths()[20]);
  kept.catch_up();
  EXPECT_EQ(kept.keeper->view().views.size(), 2U);
}

// Counts work instead of time: to and fro in a long corridor, of 2,000 keyframes the last cost what the first did.
TEST(SpaceKeeperLimits, ManyKeyframesCostTheSameEach) {
  KeptMap kept;
  kept.up();
  const auto work_of = [&](int from, int to) {
    int checked = 0, summed = 0;
    for (int k = from; k < to; ++k) {
      const KeyframeId before{static_cast<std::uint32_t>(k - 1), 0};
      kept.add(standing_at(0.3 * k), test::depth_row(),
               k % 50 == 0 ? KeyframeId{} : kept.map.stretch_of(before));
      std::vector<EditOperation> moves;
      for (int m = std::max(0, k - 5); m <= k; ++m)
        moves.emplace_back(
            MoveKeyframe{{static_cast<std::uint32_t>(m), 0}, standing_at(0.3 * m, 0.001 * (k % 3))});
      kept.edit(std::move(moves));
      if (k % 5 != 4) continue;
      kept.catch_up(false);
      EXPECT_LE(kept.keeper->last_work().carved, 5);
      checked += kept.keeper->last_work().checked;
      summed += kept.keeper->last_work().summed;
    }
    return checked + summed;
  };
  const int first = work_of(0, 100);
  work_of(100, 1900);
  EXPECT_LE(work_of(1900, 2000), 1.3 * first);
}

}  // namespace
}  // namespace vsgraphs
