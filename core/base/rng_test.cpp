#include "core/base/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace vsgraphs {
namespace {

TEST(Rng, RepeatsByItsThreeNamesAndDiffersByEach) {
  const auto first = [](std::uint64_t seed, const char* stage, std::uint64_t id) {
    return Rng(seed, stage, id).next();
  };
  EXPECT_EQ(first(1, "a", 2), first(1, "a", 2));
  EXPECT_NE(first(1, "a", 2), first(2, "a", 2));
  EXPECT_NE(first(1, "a", 2), first(1, "b", 2));
  EXPECT_NE(first(1, "a", 2), first(1, "a", 3));
}

TEST(Rng, DistributionsHaveTheirMoments) {
  Rng rng(5, "moments", 0);
  constexpr int n = 200000;
  double uniform = 0, normal = 0, square = 0;
  std::vector<int> counts(7);
  for (int i = 0; i < n; ++i) {
    uniform += rng.uniform();
    const double x = rng.normal();
    normal += x;
    square += x * x;
    ++counts[rng.index(7)];
  }
  EXPECT_NEAR(uniform / n, 0.5, 0.003);
  EXPECT_NEAR(normal / n, 0.0, 0.01);
  EXPECT_NEAR(square / n, 1.0, 0.02);
  const auto [low, high] = std::minmax_element(counts.begin(), counts.end());
  EXPECT_GT(*low, n / 7 * 0.95);
  EXPECT_LT(*high, n / 7 * 1.05);
}

}  // namespace
}  // namespace vsgraphs
