// Planes from noisy depth: as near to the truth as their information says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/surfaces/plane_extraction.h"
#include "core/scene/surfaces/test_surfaces.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::SizeIs;

const Camera camera;

KeyframeSurfaces extract_noisy(const World& world, const Se3& pose, std::uint64_t seed) {
  Rng rng(seed, "plane_extraction_noise_test", 0);
  return extract_planes(view(world, pose, camera, &rng), nullptr, camera, {});
}

const SurfacePatch& largest(const KeyframeSurfaces& surfaces) {
  return *std::max_element(
      surfaces.patches.begin(), surfaces.patches.end(),
      [](const SurfacePatch& a, const SurfacePatch& b) { return a.samples < b.samples; });
}

// By distance, along the line of sight, and how far turned.
class NoisyWall : public ::testing::TestWithParam<std::pair<double, double>> {
 protected:
  NoisyWall() {
    const auto [distance_m, turn_rad] = GetParam();
    const Eigen::Vector3d along(std::cos(turn_rad), std::sin(turn_rad), 0);
    const Eigen::Vector3d foot(0, distance_m, 0);
    world = World().sheet(foot - 5 * along + Eigen::Vector3d(0, 0, -5), 10 * along, {0, 0, 10});
    truth = plane_at(foot, along.cross(Eigen::Vector3d::UnitZ())).transformed(pose.inverse());
    if (truth.signed_distance(Eigen::Vector3d::Zero()) < 0)
      truth = {-truth.normal, truth.anchor, -truth.offset_m};
  }
  World world;
  Se3 pose = looking({0, 0, 0}, {0, 1, 0});
  AnchoredPlane truth;
};

TEST_P(NoisyWall, IsFoundWhereItIsWithinItsSigma) {
  double sum = 0;
  constexpr int runs = 20;
  for (int i = 0; i < runs; ++i) {
    const KeyframeSurfaces found = extract_noisy(world, pose, static_cast<std::uint64_t>(i));
    ASSERT_FALSE(found.patches.empty());
    const SurfacePatch& patch = largest(found);
    const Eigen::Vector3d error = patch.plane.local(truth.anchored_at(patch.plane.anchor));
    const double chi2 = error.dot(patch.information * error);
    EXPECT_LT(chi2, 16.3) << "beyond 99.9 %";
    sum += chi2;
  }
  // The information is that of thirty readings though thousands were averaged: less than three degrees of freedom.
  EXPECT_LT(sum / runs, 3.0);
}

TEST_P(NoisyWall, BothTiltsAreKnownAndNotBetterThanTheyCanBe) {
  const SurfacePatch patch = largest(extract_noisy(world, pose, 1));
  const double offset_sigma_m = 1 / std::sqrt(patch.information(2, 2));
  EXPECT_GT(offset_sigma_m, 0.003 / std::sqrt(30.0) - 1e-9) << "surfaces are flat to 3 mm at best";
  EXPECT_LT(offset_sigma_m, 0.02);
  for (int axis : {0, 1}) {
    const double tilt_sigma_rad = 1 / std::sqrt(patch.information(axis, axis));
    EXPECT_GT(tilt_sigma_rad, 1e-4) << axis;
    EXPECT_LT(tilt_sigma_rad, 0.02) << axis;
  }
}

TEST_P(NoisyWall, ComesOutTheSameEveryTime) {
  const KeyframeSurfaces first = extract_noisy(world, pose, 5), second = extract_noisy(world, pose, 5);
  ASSERT_EQ(first.patches.size(), second.patches.size());
  for (std::size_t i = 0; i < first.patches.size(); ++i) {
    EXPECT_EQ(first.patches[i].plane.normal, second.patches[i].plane.normal);
    EXPECT_EQ(first.patches[i].plane.anchor, second.patches[i].plane.anchor);
    EXPECT_EQ(first.patches[i].information, second.patches[i].information);
    EXPECT_EQ(first.patches[i].points, second.patches[i].points);
  }
}

INSTANTIATE_TEST_SUITE_P(DistancesAndTurns, NoisyWall,
                         ::testing::Values(std::pair{1.0, 0.0}, std::pair{2.0, 0.0}, std::pair{3.5, 0.0},
                                           std::pair{2.0, 0.5}, std::pair{2.0, -0.9}));

TEST(NoisyRoom, WallsFloorAndTheirOrderAreFoundInNoise) {
  const World world = World().room({-3, -3, 0}, {2, 2, 6});
  const Se3 pose = looking({0, 0, 1.5}, {2, 2, 0.6});
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const KeyframeSurfaces found = extract_noisy(world, pose, seed);
    int matched = 0;
    for (const auto& [point, normal] : {std::pair<Eigen::Vector3d, Eigen::Vector3d>{{2, 0, 1}, {-1, 0, 0}},
                                        {{0, 2, 1}, {0, -1, 0}},
                                        {{0, 0, 0}, {0, 0, 1}}}) {
      const AnchoredPlane truth = plane_at(point, normal).transformed(pose.inverse());
      for (const SurfacePatch& patch : found.patches)
        matched += patch.samples > 500 && truth.normal.dot(patch.plane.normal) > 0.9995 &&
                   std::abs(truth.signed_distance(patch.plane.anchor)) < 0.01;
    }
    EXPECT_EQ(matched, 3) << "seed " << seed;
  }
}

// A stray patch would become a wall that is not there.
TEST(NoisyRoom, NoiseMakesNoPlanesOfABall) {
  World world;
  world.balls.push_back({{0, 1.5, 0}, 0.5});
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    EXPECT_THAT(extract_noisy(world, looking({0, 0, 0}, {0, 1, 0}), seed).patches, SizeIs(0))
        << "seed " << seed;
}

}  // namespace
}  // namespace vsgraphs
