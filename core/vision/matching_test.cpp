#include "core/vision/matching.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/base/check.h"
#include "core/base/rng.h"
#include "core/vision/rotation_vote.h"

namespace vsgraphs {
namespace {

Descriptor random_descriptor(Rng& rng) { return {{rng.next(), rng.next(), rng.next(), rng.next()}}; }

Descriptor with_flips(Descriptor d, int from_bit, int count) {
  for (int i = from_bit; i < from_bit + count; ++i)
    d.words[static_cast<std::size_t>(i / 64)] ^= 1ull << (i % 64);
  return d;
}

Feature at(float u, float v, int level = 0, float angle = 0, float depth = 0) {
  Feature f;
  f.u = u;
  f.v = v;
  f.level = static_cast<std::uint8_t>(level);
  f.angle_rad = angle;
  f.depth_m = depth;
  return f;
}

ProjectedPoint look(float u, float v, const Descriptor& d, float radius = 10, int min_level = 0,
                    int max_level = 7) {
  ProjectedPoint p;
  p.u = u;
  p.v = v;
  p.radius_px = radius;
  p.min_level = min_level;
  p.max_level = max_level;
  p.descriptor = &d;
  return p;
}

class MatchProjected : public testing::Test {
 protected:
  Rng rng{7, "matching_test", 0};
  Descriptor d = random_descriptor(rng), other = random_descriptor(rng);
};

TEST_F(MatchProjected, TakesTheClosestDescriptorInTheWindowAndLevels) {
  const FeatureSet set({at(100, 100), at(104, 100), at(150, 100), at(103, 103, 5)},
                       {with_flips(d, 0, 40), with_flips(d, 0, 10), d, d}, 640, 480);
  const std::vector<ProjectedPoint> points{look(101, 101, d, 10, 0, 1), look(101, 101, d, 10, 4, 7),
                                           look(300, 300, d)};
  EXPECT_EQ(match_projected(points, set, {.ratio = 1}), (std::vector<int>{1, 3, -1}));
}

TEST_F(MatchProjected, RefusesTheAmbiguousButOnlyAtOneLevel) {
  const MatchOptions options{.ratio = 0.8};
  const std::vector<ProjectedPoint> points{look(100, 100, d)};
  const FeatureSet same({at(100, 100), at(104, 100)}, {with_flips(d, 0, 30), with_flips(d, 50, 32)}, 640,
                        480);
  EXPECT_EQ(match_projected(points, same, options)[0], -1);
  const FeatureSet levels({at(100, 100), at(104, 100, 1)}, {with_flips(d, 0, 30), with_flips(d, 50, 32)}, 640,
                          480);
  EXPECT_EQ(match_projected(points, levels, options)[0], 0);
  const FeatureSet far({at(100, 100)}, {with_flips(d, 0, 101)}, 640, 480);
  EXPECT_EQ(match_projected(points, far, options)[0], -1);
}

TEST_F(MatchProjected, AFeatureGoesToOnePointAndTakenOnesToNone) {
  const FeatureSet set({at(100, 100)}, {d}, 640, 480);
  const Descriptor near = with_flips(d, 0, 5), nearer = with_flips(d, 0, 2);
  const std::vector<ProjectedPoint> points{look(99, 99, near), look(101, 101, nearer),
                                           look(100, 100, nearer)};
  EXPECT_EQ(match_projected(points, set, {}), (std::vector<int>{-1, 0, -1}));
  const std::vector<std::uint8_t> taken{1};
  EXPECT_EQ(match_projected(points, set, {}, taken), (std::vector<int>{-1, -1, -1}));
  const std::vector<std::uint8_t> wrong{1, 0};
  EXPECT_THROW(match_projected(points, set, {}, wrong), InputError);
}

TEST_F(MatchProjected, GatesByInverseDepth) {
  const FeatureSet set({at(100, 100, 0, 0, 2.0f), at(102, 100, 0, 0, 4.0f), at(104, 100)},
                       {d, with_flips(d, 0, 20), with_flips(d, 0, 60)}, 640, 480);
  ProjectedPoint p = look(100, 100, d);
  p.inverse_depth = 0.25f;
  p.inverse_depth_gate = 0.05f;
  EXPECT_EQ(match_projected(std::vector{p}, set, {})[0], 1);
  p.inverse_depth = 1.0f;
  EXPECT_EQ(match_projected(std::vector{p}, set, {})[0], 2) << "no depth, no contradiction";
  p.inverse_depth_gate = 0;
  EXPECT_EQ(match_projected(std::vector{p}, set, {})[0], 0);
}

TEST_F(MatchProjected, RotationCheckDropsTheOddOnes) {
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;
  for (int i = 0; i < 40; ++i) {
    features.push_back(at(20.0f + 15.0f * static_cast<float>(i), 100, 0, i == 7 ? 2.5f : 0.3f));
    descriptors.push_back(random_descriptor(rng));
  }
  const FeatureSet set(features, descriptors, 640, 480);
  std::vector<ProjectedPoint> points;
  for (int i = 0; i < 40; ++i) {
    ProjectedPoint p = look(set[i].u, 100, set.descriptor(i), 5);
    p.has_angle = i != 8;
    p.angle_rad = 0.0f;
    points.push_back(p);
  }
  const std::vector<int> match = match_projected(points, set, {.check_rotation = true});
  for (int i = 0; i < 40; ++i) EXPECT_EQ(match[static_cast<std::size_t>(i)], i == 7 ? -1 : i);
}

struct Pair {
  FeatureSet a, b;
};
// b holds a's descriptors with noise, in reverse order.
Pair shuffled_pair(int count, int noise_bits) {
  Rng rng(3, "shuffled_pair", 0);
  std::vector<Feature> fa, fb;
  std::vector<Descriptor> da, db;
  for (int i = 0; i < count; ++i) {
    fa.push_back(at(static_cast<float>(i), 10));
    da.push_back(random_descriptor(rng));
  }
  for (int i = count - 1; i >= 0; --i) {
    fb.push_back(at(static_cast<float>(i), 10, 0, 1.0f));
    db.push_back(with_flips(da[static_cast<std::size_t>(i)], static_cast<int>(rng.index(150)), noise_bits));
  }
  return {{fa, da, 640, 480}, {fb, db, 640, 480}};
}

TEST(MatchDescriptors, FindsEveryPairOfAShuffledSet) {
  const Pair s = shuffled_pair(300, 30);
  const IndexPairs pairs = match_descriptors(s.a, s.b, {});
  ASSERT_EQ(pairs.size(), 300u);
  for (int i = 0; i < 300; ++i) EXPECT_EQ(pairs[static_cast<std::size_t>(i)], std::pair(i, 299 - i));
  EXPECT_TRUE(match_descriptors(s.a, s.b, {.max_distance = 29}).empty());
  EXPECT_TRUE(match_descriptors(s.a, FeatureSet{}, {}).empty());
  EXPECT_TRUE(match_descriptors(FeatureSet{}, s.b, {}).empty());
}

TEST(MatchDescriptors, SeesOnlyTheSubsets) {
  const Pair s = shuffled_pair(50, 10);
  const std::vector<int> in_a{3, 10, 20}, in_b{29, 39, 48};
  EXPECT_EQ(match_descriptors(s.a, in_a, s.b, in_b, {}), (IndexPairs{{10, 39}, {20, 29}}));
  EXPECT_TRUE(match_descriptors(s.a, {}, s.b, in_b, {}).empty());
}

TEST(MatchDescriptors, WantsMutualAndDistinctMatches) {
  Rng rng(5, "mutual", 0);
  const Descriptor d = random_descriptor(rng);
  const FeatureSet a({at(1, 1), at(2, 2)}, {with_flips(d, 0, 10), with_flips(d, 0, 4)}, 640, 480);
  const FeatureSet b({at(1, 1)}, {d}, 640, 480);
  EXPECT_EQ(match_descriptors(a, b, {}), (IndexPairs{{1, 0}}));
  const FeatureSet twins({at(1, 1), at(9, 9)}, {d, with_flips(d, 100, 1)}, 640, 480);
  EXPECT_TRUE(match_descriptors(b, twins, {.ratio = 0.9}).size() == 1) << "0 < 0.9 * 1";
  EXPECT_TRUE(match_descriptors(a, twins, {.ratio = 0.7}).empty());
}

TEST(MatchDescriptors, TheSameCornerAtAnotherLevelIsNoRival) {
  Rng rng(6, "same_corner", 0);
  const Descriptor d = random_descriptor(rng);
  const FeatureSet a({at(50, 50)}, {d}, 640, 480);
  const std::vector<Descriptor> looks{with_flips(d, 0, 20), with_flips(d, 50, 21), with_flips(d, 90, 60)};
  const MatchOptions options{.ratio = 0.8};
  EXPECT_TRUE(
      match_descriptors(a, {{at(50, 50), at(53, 52), at(300, 300)}, looks, 640, 480}, options).empty());
  EXPECT_TRUE(
      match_descriptors(a, {{at(50, 50), at(60, 52, 1), at(300, 300)}, looks, 640, 480}, options).empty());
  EXPECT_EQ(match_descriptors(a, {{at(50, 50), at(53, 52, 1), at(300, 300)}, looks, 640, 480}, options),
            (IndexPairs{{0, 0}}));
  // Behind the twin the next rival still counts.
  EXPECT_TRUE(
      match_descriptors(a, {{at(50, 50), at(53, 52, 1), at(300, 300)}, looks, 640, 480}, {.ratio = 0.3})
          .empty());
}

TEST(MatchEpipolar, KeepsToTheLine) {
  // Cameras side by side: the epipolar line of a pixel is its own row.
  Eigen::Matrix3d f;
  f << 0, 0, 0, 0, 0, -1, 0, 1, 0;
  Rng rng(5, "epipolar", 0);
  const Descriptor d = random_descriptor(rng);
  const FeatureSet a({at(100, 50)}, {d}, 640, 480);
  const FeatureSet b({at(200, 57), at(150, 51.5f), at(90, 52.5f, 4)},
                     {d, with_flips(d, 0, 30), with_flips(d, 0, 20)}, 640, 480);
  const std::vector<int> in_a{0}, in_b{0, 1, 2}, fine{0, 1};
  const ScalePyramid scales;
  EXPECT_EQ(match_epipolar(a, in_a, b, in_b, f, scales, 2, {}), (IndexPairs{{0, 2}}))
      << "level 4 reaches 4.1 px";
  EXPECT_EQ(match_epipolar(a, in_a, b, fine, f, scales, 2, {}), (IndexPairs{{0, 1}}));
  EXPECT_TRUE(match_epipolar(a, in_a, b, fine, f, scales, 1, {}).empty());
  EXPECT_THROW(match_epipolar(a, in_a, b, in_b, Eigen::Matrix3d::Zero(), scales, 2, {}), InputError);
}

TEST(Representative, IsTheMiddleOne) {
  Rng rng(5, "representative", 0);
  const Descriptor d = random_descriptor(rng);
  const std::vector<Descriptor> all{with_flips(d, 0, 20), random_descriptor(rng), d, with_flips(d, 50, 20),
                                    with_flips(d, 90, 20)};
  EXPECT_EQ(representative(all), d);
  EXPECT_EQ(representative(std::span(all).first(1)), all[0]);
  EXPECT_THROW(representative({}), InputError);
}

TEST(ConsistentRotation, WrapsAroundAndKeepsNeighbours) {
  const float pi = std::numbers::pi_v<float>;
  const std::vector<float> turns{0.01f, -0.01f, 2 * pi + 0.02f, -2 * pi, 0.2f, 0.21f, -0.2f, -0.19f, pi};
  const std::vector<bool> kept = consistent_rotation(turns);
  for (std::size_t i = 0; i + 1 < turns.size(); ++i) EXPECT_TRUE(kept[i]) << i;
  EXPECT_FALSE(kept.back());
  EXPECT_TRUE(consistent_rotation({}).empty());
}

}  // namespace
}  // namespace vsgraphs
