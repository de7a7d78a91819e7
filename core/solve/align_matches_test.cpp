#include "core/solve/align_matches.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

const Intrinsics intrinsics;

double distance(const Se3& a, const Se3& b) { return (a.inverse() * b).log().norm(); }

TEST(AlignMatches, FindsThePoseAmongHalfWrongMatches) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SyntheticView view = synthetic_view(200, 100, true, seed);
    const auto s = align_matches(intrinsics, view.observations, Rng(seed, "align_matches_test", 0));
    ASSERT_TRUE(s) << seed;
    EXPECT_LT(distance(s->world_from_camera, view.world_from_camera), 0.015);
    int kept_wrong = 0;
    for (int i = 0; i < 100; ++i) kept_wrong += is_inlier(s->fit[i]);
    EXPECT_LE(kept_wrong, 3);
    EXPECT_GE(s->inliers, 85);
  }
}

TEST(AlignMatches, FindsThirtyGoodOnesAmongAHundred) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SyntheticView view = synthetic_view(100, 70, true, seed, 0.9);
    const auto s = align_matches(intrinsics, view.observations, Rng(seed, "align_matches_test", 1));
    found += s && distance(s->world_from_camera, view.world_from_camera) < 0.03;
  }
  EXPECT_GE(found, 18);
}

TEST(AlignMatches, NothingToFindIsNothing) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SyntheticView wrong = synthetic_view(150, 150, true, seed);
    EXPECT_FALSE(align_matches(intrinsics, wrong.observations, Rng(seed, "align_matches_test", 2)));
  }
  EXPECT_FALSE(align_matches(intrinsics, {}, Rng(1, "align_matches_test", 3)));
  const SyntheticView few = synthetic_view(5, 0);
  EXPECT_FALSE(align_matches(intrinsics, few.observations, Rng(1, "align_matches_test", 3)));
  const SyntheticView no_depth = synthetic_view(100, 0, true, 1, 0.0);
  EXPECT_FALSE(align_matches(intrinsics, no_depth.observations, Rng(1, "align_matches_test", 3)));
}

TEST(AlignMatches, SameSeedSameBytes) {
  const SyntheticView view = synthetic_view(200, 100);
  const auto a = align_matches(intrinsics, view.observations, Rng(7, "align_matches_test", 4));
  const auto b = align_matches(intrinsics, view.observations, Rng(7, "align_matches_test", 4));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(0, std::memcmp(&a->world_from_camera, &b->world_from_camera, sizeof(Se3)));
}

}  // namespace
}  // namespace vsgraphs
