#include "core/scene/space/free_space.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

// A camera at the origin that looks along +x: (x, y, z) of the level is (depth, -right, -down).
Se3 looking_along_x(const Eigen::Vector3d& at = {0.05, 0.05, 0.05}) {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {axes, at};
}

std::shared_ptr<DepthGrid> grid_of(std::vector<Eigen::Vector3f> points) {
  auto grid = std::make_shared<DepthGrid>();
  grid->columns = static_cast<int>(points.size());
  grid->rows = 1;
  grid->samples.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) grid->samples[i].point = points[i];
  return grid;
}

std::shared_ptr<DepthGrid> random_grid(std::uint64_t seed) {
  Rng rng(seed, "free_space_test", 0);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 500; ++i) {
    const double z = rng.uniform() < 0.1 ? 0 : rng.uniform(0.4, 6);
    points.emplace_back(
        Eigen::Vector3d(rng.uniform(-0.6, 0.6) * z, rng.uniform(-0.45, 0.45) * z, z).cast<float>());
  }
  return grid_of(points);
}

Se3 random_pose(std::uint64_t seed) {
  Rng rng(seed, "free_space_test_pose", 0);
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = rng.uniform(-1.5, 1.5);
  return Se3::exp(xi);
}

KeyframeId id(std::uint32_t index) { return {index, 0}; }

void expect_equal(const VoxelBlocks& a, const VoxelBlocks& b) {
  for (const auto* from : {&a, &b}) {
    const VoxelBlocks& other = from == &a ? b : a;
    for (const VoxelBlocks::Block& block : from->blocks())
      for (int i = 0; i < static_cast<int>(block.voxels.size()); ++i) {
        const Eigen::Vector3i in_block(i % 8, i / 8 % 8, i / 64);
        const Voxel there = other.at(block.origin + in_block),
                    here = block.voxels[static_cast<std::size_t>(i)];
        ASSERT_EQ(here.passes, there.passes);
        ASSERT_EQ(here.hits, there.hits);
      }
  }
}

TEST(FreeSpace, ARayPassesUntilItHitsAndNothingIsKnownBehind) {
  FreeSpace space({});
  space.integrate(id(0), grid_of({{0, 0, 2}, {0, 0, 2}, {0.001f, 0, 2}}), looking_along_x());
  for (int x = 0; x < 20; ++x) EXPECT_TRUE(space.voxels().at({x, 0, 0}).free()) << x;
  EXPECT_TRUE(space.voxels().at({20, 0, 0}).occupied());
  EXPECT_EQ(space.voxels().at({20, 0, 0}).hits, 3u);
  EXPECT_TRUE(space.voxels().at({21, 0, 0}).empty());
  EXPECT_TRUE(space.voxels().at({10, 1, 0}).empty());
}

TEST(FreeSpace, NoReadingCarvesNothingAndFarOnesHitNothing) {
  FreeSpace space({});
  space.integrate(id(0), grid_of({{0, 0, 0}, {1, 0, 0}}), looking_along_x());
  EXPECT_TRUE(space.voxels().blocks().empty());
  space.integrate(id(1), grid_of({{0, 0, 5.5f}, {0, 0, 5.5f}}), looking_along_x());
  EXPECT_TRUE(space.voxels().at({39, 0, 0}).free());
  EXPECT_TRUE(space.voxels().at({41, 0, 0}).empty());
  for (const VoxelBlocks::Block& block : space.voxels().blocks())
    for (const Voxel& voxel : block.voxels) EXPECT_EQ(voxel.hits, 0u);
}

TEST(FreeSpace, RaysSlantedThroughNegativeCoordinatesEndWhereTheyShould) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    FreeSpace space({});
    const Se3 pose = random_pose(seed);
    Rng rng(seed, "slanted", 0);
    const Eigen::Vector3f p =
        Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.5, 2)).cast<float>();
    space.integrate(id(0), grid_of({p, p}), pose);
    const Eigen::Vector3d end = pose * p.cast<double>().eval();
    EXPECT_EQ(space.voxels().at((end * 10).array().floor().cast<int>().matrix()).hits, 2u);
    // A point anywhere along the way lies in a voxel that was passed.
    for (double share = 0; share < 0.9; share += 0.05) {
      const Eigen::Vector3d on_way = pose.translation() + share * (end - pose.translation());
      const Voxel voxel = space.voxels().at((on_way * 10).array().floor().cast<int>().matrix());
      EXPECT_TRUE(voxel.passes + voxel.hits > 0) << seed << " " << share;
    }
  }
}

TEST(FreeSpace, WhatAKeyframeCarvedIsTakenOutExactly) {
  FreeSpace one({}), both({});
  one.integrate(id(0), random_grid(0), random_pose(0));
  both.integrate(id(1), random_grid(1), random_pose(1));
  both.integrate(id(0), random_grid(0), random_pose(0));
  both.remove(id(1));
  both.remove(id(7));
  expect_equal(one.voxels(), both.voxels());
  EXPECT_EQ(both.views().size(), 1u);
  both.remove(id(0));
  for (const VoxelBlocks::Block& block : both.voxels().blocks())
    for (const Voxel& voxel : block.voxels) ASSERT_TRUE(voxel.empty());
}

TEST(FreeSpace, AgainAtACorrectedPoseIsAsIfFromThere) {
  FreeSpace moved({}), fresh({});
  for (std::uint32_t k = 0; k < 3; ++k) {
    moved.integrate(id(k), random_grid(k), random_pose(k));
    fresh.integrate(id(k), random_grid(k), random_pose(k + 10));
    moved.integrate(id(k), random_grid(k), random_pose(k + 10));
  }
  expect_equal(moved.voxels(), fresh.voxels());
}

TEST(FreeSpace, RefreshTakesThoseThatMovedMostFirstAndAFewAtATime) {
  FreeSpace space({});
  std::vector<KeyframePose> poses;
  for (std::uint32_t k = 0; k < 5; ++k) {
    space.integrate(id(k), random_grid(k), random_pose(k));
    // By 0, 2, 4, 6, 8 cm; the first two stay below the threshold.
    const Se3 shift(Eigen::Matrix3d::Identity(), {0.02 * k, 0, 0});
    poses.push_back({id(k), shift * random_pose(k)});
  }
  poses.push_back({id(99), Se3()});  // never carved
  const auto moved_to = [&](std::uint32_t k) {
    return (space.views().at(id(k)).level_from_camera.translation() - random_pose(k).translation()).norm();
  };
  EXPECT_EQ(space.refresh(poses, 2), 1);
  EXPECT_NEAR(moved_to(4), 0.08, 1e-9);
  EXPECT_NEAR(moved_to(3), 0.06, 1e-9);
  EXPECT_EQ(moved_to(2), 0);
  EXPECT_EQ(space.refresh(poses, 2), 0);
  EXPECT_NEAR(moved_to(2), 0.04, 1e-9);
  const std::uint64_t version = space.version();
  EXPECT_EQ(space.refresh(poses, 2), 0);
  EXPECT_EQ(space.version(), version);
  EXPECT_EQ(moved_to(1), 0);

  FreeSpace fresh({});
  for (std::uint32_t k = 0; k < 5; ++k)
    fresh.integrate(id(k), random_grid(k), k < 2 ? random_pose(k) : poses[k].level_from_camera);
  expect_equal(space.voxels(), fresh.voxels());
}

TEST(FreeSpace, ATurnAloneIsACorrectionToo) {
  FreeSpace space({});
  space.integrate(id(0), random_grid(0), Se3());
  const double degrees = 0.8 * std::numbers::pi / 180;
  const std::vector<KeyframePose> turned{{id(0), Se3(so3_exp({0, 0, degrees}), {0, 0, 0})}};
  EXPECT_EQ(space.refresh(turned, 0), 1);
  EXPECT_EQ(space.refresh(turned, 1), 0);
  EXPECT_EQ(space.views().at(id(0)).level_from_camera.rotation(), turned[0].level_from_camera.rotation());
}

TEST(FreeSpace, MemoryIsBounded) {
  FreeSpaceOptions options;
  options.max_blocks = 60;
  FreeSpace space(options);
  ASSERT_TRUE(space.integrate(id(0), random_grid(0), random_pose(0)));
  ASSERT_GE(space.voxels().blocks().size(), 60u);
  const std::size_t before = space.memory_bytes();
  EXPECT_GE(before, 60 * sizeof(VoxelBlocks::Block));
  EXPECT_FALSE(space.integrate(id(1), random_grid(1), random_pose(1)));
  EXPECT_EQ(space.memory_bytes(), before);
  EXPECT_EQ(space.views().size(), 1u);
  // Room is made by what is taken out.
  space.remove(id(0));
  EXPECT_TRUE(space.integrate(id(1), random_grid(1), random_pose(1)));
}

}  // namespace
}  // namespace vsgraphs
