#include "core/map/features.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/check.h"
#include "core/base/rng.h"

namespace vsgraphs {
namespace {

FeatureSet random_features(int count) {
  Rng rng(3, "features", 0);
  std::vector<Feature> features(static_cast<std::size_t>(count));
  for (Feature& f : features) {
    // A little outside too: undistortion pushes corners there.
    f.u = static_cast<float>(rng.uniform(-20, 660));
    f.v = static_cast<float>(rng.uniform(-20, 500));
    f.level = static_cast<std::uint8_t>(rng.index(8));
  }
  return {features, std::vector<Descriptor>(features.size()), 640, 480};
}

TEST(FeatureSet, AreaSearchFindsWhatALookAtAllFinds) {
  const FeatureSet set = random_features(1500);
  Rng rng(4, "queries", 0);
  for (int q = 0; q < 200; ++q) {
    const auto u = static_cast<float>(rng.uniform(-30, 670)), v = static_cast<float>(rng.uniform(-30, 510));
    const auto radius = static_cast<float>(rng.uniform(1, 80));
    std::vector<int> found, expected;
    set.in_area(u, v, radius, 1, 4, found);
    for (int i = 0; i < set.size(); ++i) {
      const Feature& f = set[i];
      if (f.level >= 1 && f.level <= 4 && std::abs(f.u - u) < radius && std::abs(f.v - v) < radius) {
        expected.push_back(i);
      }
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

TEST(FeatureSet, EmptySetFindsNothing) {
  std::vector<int> found;
  FeatureSet().in_area(10, 10, 50, 0, 7, found);
  FeatureSet({}, {}, 640, 480).in_area(10, 10, 50, 0, 7, found);
  EXPECT_TRUE(found.empty());
}

TEST(FeatureSet, RefusesUnequalLengths) {
  EXPECT_THROW(FeatureSet(std::vector<Feature>(2), std::vector<Descriptor>(1), 640, 480), InvariantError);
}

TEST(Descriptor, HammingCountsBits) {
  Descriptor a, b;
  b.words = {1, 3, 0, ~0ULL};
  EXPECT_EQ(hamming(a, a), 0);
  EXPECT_EQ(hamming(a, b), 1 + 2 + 64);
}

}  // namespace
}  // namespace vsgraphs
