#include "core/vision/orb_extractor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <set>

#include "core/base/check.h"
#include "core/vision/brief_pattern.h"
#include "core/vision/matching.h"
#include "core/vision/test_images.h"

namespace vsgraphs {
namespace {

struct Bench {
  Camera camera;
  Image<std::uint8_t> image = test::textured_image(640, 480, 1);
  Image<float> depth{640, 480, 2.0f};
  DepthView depth_view() const { return {{}, depth.view()}; }
  FeatureSet extract(const Image<std::uint8_t>& grey, OrbOptions options = {}) const {
    return OrbExtractor(options, camera).extract(grey.view(), depth_view(), {});
  }
};

// Share of matches that lie where the warp says (within 2 sigma of the level), and their number.
struct Quality {
  double precision = 0;
  int correct = 0;
};
Quality match_quality(const Bench& bench, const Eigen::Matrix<double, 2, 3>& from_new) {
  // Both views pass through the same sampling, or one would be sharper than the other.
  const FeatureSet a = bench.extract(test::warped(bench.image, test::similarity(bench.image, 0, 1)));
  const FeatureSet b = bench.extract(test::warped(bench.image, from_new));
  const IndexPairs pairs =
      match_descriptors(a, b, {.max_distance = 64, .ratio = 0.9, .check_rotation = true});
  Quality quality;
  for (const auto& [i, j] : pairs) {
    const Eigen::Vector2d expected = from_new * Eigen::Vector3d(b[j].u, b[j].v, 1);
    const double sigma = ScalePyramid{}.level_sigma_px(std::max(a[i].level, b[j].level));
    quality.correct += (expected - Eigen::Vector2d(a[i].u, a[i].v)).norm() < 2 * sigma;
  }
  quality.precision =
      pairs.empty() ? 0 : static_cast<double>(quality.correct) / static_cast<double>(pairs.size());
  return quality;
}

TEST(OrbExtractor, GivesTheWantedNumberAtAllLevelsAndEverywhere) {
  const Bench bench;
  const FeatureSet set = bench.extract(bench.image);
  EXPECT_EQ(set.size(), 1000);
  std::array<int, 8> per_level{};
  std::array<int, 12> per_tile{};
  for (const Feature& f : set.features()) {
    ++per_level[f.level];
    ++per_tile[static_cast<std::size_t>(static_cast<int>(f.v) / 160 * 4 + static_cast<int>(f.u) / 160)];
    EXPECT_FLOAT_EQ(f.depth_m, 2.0f);
  }
  for (std::size_t i = 1; i < 8; ++i) EXPECT_LT(per_level[i], per_level[i - 1]);
  EXPECT_GT(per_level[7], 40);
  for (int n : per_tile) EXPECT_GT(n, 40);
}

TEST(OrbExtractor, TheSameInputGivesTheSameBytes) {
  const Bench bench;
  OrbExtractor extractor({}, bench.camera);
  const FeatureSet first = extractor.extract(bench.image.view(), bench.depth_view(), {});
  extractor.extract(test::textured_image(640, 480, 2).view(), bench.depth_view(),
                    {});  // leaves its traces in the buffers
  const FeatureSet again = extractor.extract(bench.image.view(), bench.depth_view(), {});
  ASSERT_EQ(first.size(), again.size());
  EXPECT_EQ(first.descriptors(), again.descriptors());
  for (int i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].u, again[i].u);
    EXPECT_EQ(first[i].v, again[i].v);
    EXPECT_EQ(first[i].angle_rad, again[i].angle_rad);
    EXPECT_EQ(first[i].level, again[i].level);
  }
}

TEST(OrbExtractor, FindsTheSceneAgainShiftedTurnedAndScaled) {
  const Bench bench;
  const auto quality = [&](double degrees, double scale, Eigen::Vector2d shift) {
    return match_quality(bench,
                         test::similarity(bench.image, degrees * std::numbers::pi / 180, scale, shift));
  };
  const Quality shifted = quality(0, 1, {12.5, -7.25});
  EXPECT_GT(shifted.correct, 300);
  EXPECT_GT(shifted.precision, 0.95);
  for (double degrees : {30.0, 97.0, 180.0}) {
    const Quality turned = quality(degrees, 1, {0, 0});
    EXPECT_GT(turned.correct, 200) << degrees;
    EXPECT_GT(turned.precision, 0.9) << degrees;
  }
  const Quality scaled = quality(10, 1.5, {0, 0});
  EXPECT_GT(scaled.correct, 80);
  EXPECT_GT(scaled.precision, 0.85);
}

TEST(OrbExtractor, PositionsAreFinerThanPixels) {
  const Bench bench;
  const Eigen::Matrix<double, 2, 3> from_new = test::similarity(bench.image, 0, 1, {0.4, -0.3});
  const FeatureSet a = bench.extract(test::warped(bench.image, test::similarity(bench.image, 0, 1)));
  const FeatureSet b = bench.extract(test::warped(bench.image, from_new));
  std::vector<double> errors;
  for (const auto& [i, j] : match_descriptors(a, b, {.max_distance = 64, .ratio = 0.9})) {
    if (a[i].level != 0 || b[j].level != 0) continue;
    const Eigen::Vector2d expected = from_new * Eigen::Vector3d(b[j].u, b[j].v, 1);
    errors.push_back((expected - Eigen::Vector2d(a[i].u, a[i].v)).norm());
  }
  ASSERT_GT(errors.size(), 50u);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.35) << "whole pixels would be off by 0.5";
}

TEST(OrbExtractor, OrientationFollowsTheImage) {
  const Bench bench;
  const double turn = 0.5;
  const Eigen::Matrix<double, 2, 3> from_new = test::similarity(bench.image, turn, 1);
  const FeatureSet a = bench.extract(bench.image), b = bench.extract(test::warped(bench.image, from_new));
  int close = 0;
  const IndexPairs pairs = match_descriptors(a, b, {.max_distance = 50, .ratio = 0.8});
  for (const auto& [i, j] : pairs)
    close += std::abs(std::remainder(b[j].angle_rad - a[i].angle_rad - turn, 2 * std::numbers::pi)) < 0.2;
  ASSERT_GT(pairs.size(), 100u);
  EXPECT_GT(close, 0.8 * static_cast<double>(pairs.size()));
}

TEST(OrbExtractor, WeakCornersFillOnlyWhatStrongOnesLeaveEmpty) {
  Bench bench;
  for (int v = 0; v < 480; ++v)  // the right half keeps a tenth of its contrast
    for (int u = 320; u < 640; ++u)
      bench.image.at(u, v) = static_cast<std::uint8_t>(120 + bench.image.at(u, v) / 12);
  const FeatureSet set = bench.extract(bench.image);
  const auto right =
      std::count_if(set.features().begin(), set.features().end(), [](const Feature& f) { return f.u > 330; });
  EXPECT_GT(right, 150);
  const FeatureSet strong = bench.extract(bench.image, {.fast_threshold_low = 20});
  const auto strong_right = std::count_if(strong.features().begin(), strong.features().end(),
                                          [](const Feature& f) { return f.u > 330; });
  EXPECT_LT(strong_right, right / 4);
}

TEST(OrbExtractor, ReadsDepthAndColourWhereTheLensShowsThemAndUndistortsPositions) {
  Bench bench;
  bench.camera.distortion = {0.26, -0.95, -0.005, 0.003, 1.16};
  Image<Rgb> colour(640, 480);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      bench.depth.at(u, v) = static_cast<float>(1.5 + 0.001 * u);
      colour.at(u, v) = {static_cast<std::uint8_t>(u / 4), static_cast<std::uint8_t>(v / 4), 7};
    }
  }
  OrbExtractor extractor({}, bench.camera);
  const FeatureSet set = extractor.extract(bench.image.view(), bench.depth_view(), colour.view());
  double largest_shift = 0;
  for (const Feature& f : set.features()) {
    const Eigen::Vector2d raw = bench.camera.distort({f.u, f.v});
    EXPECT_NEAR(f.depth_m, 1.5 + 0.001 * raw.x(), 1e-4);
    EXPECT_NEAR(f.colour.r, raw.x() / 4, 1.2);
    EXPECT_NEAR(f.colour.g, raw.y() / 4, 1.2);
    largest_shift = std::max(largest_shift, (raw - Eigen::Vector2d(f.u, f.v)).norm());
  }
  EXPECT_GT(largest_shift, 3.0);
}

TEST(OrbExtractor, ABlankImageHasNoFeatures) {
  const Bench bench;
  EXPECT_EQ(bench.extract(Image<std::uint8_t>(640, 480, 90)).size(), 0);
}

TEST(OrbExtractor, RefusesBadInput) {
  const Bench bench;
  OrbExtractor extractor({}, bench.camera);
  EXPECT_THROW(extractor.extract({}, bench.depth_view(), {}), InputError);
  EXPECT_THROW(extractor.extract(Image<std::uint8_t>(320, 240).view(), bench.depth_view(), {}), InputError);
  EXPECT_THROW(extractor.extract(bench.image.view(), {}, {}), InputError);
  EXPECT_THROW(extractor.extract(bench.image.view(), bench.depth_view(), Image<Rgb>(100, 100).view()),
               InputError);
  EXPECT_THROW(OrbExtractor({.max_features = 0}, bench.camera), InputError);
  EXPECT_THROW(OrbExtractor({.levels = 99}, bench.camera), InputError);
  EXPECT_THROW(OrbExtractor({.scale_factor = 1.0}, bench.camera), InputError);
  EXPECT_THROW(OrbExtractor({.fast_threshold = 10, .fast_threshold_low = 11}, bench.camera), InputError);
  Camera wrong = bench.camera;
  wrong.fx = -1;
  EXPECT_THROW(OrbExtractor({}, wrong), InputError);
}

TEST(BriefPattern, ComparesDistinctPixelsInsideThePatch) {
  std::set<std::array<int, 4>> seen;
  for (const BriefPair& p : brief_pattern) {
    EXPECT_LE(p.x0 * p.x0 + p.y0 * p.y0, 14.5 * 14.5);
    EXPECT_LE(p.x1 * p.x1 + p.y1 * p.y1, 14.5 * 14.5);
    EXPECT_FALSE(p.x0 == p.x1 && p.y0 == p.y1);
    const std::array<int, 4> forward{p.x0, p.y0, p.x1, p.y1}, backward{p.x1, p.y1, p.x0, p.y0};
    EXPECT_TRUE(seen.insert(forward).second);
    EXPECT_FALSE(seen.contains(backward));
  }
}

TEST(SteeredBrief, BitIsComparisonOfTurnedPixels) {
  const Image<std::uint8_t> image = test::textured_image(64, 64, 4);
  const SteeredBrief brief(64);
  const Descriptor upright = brief.describe(image.view(), 30, 33, 0);
  const Descriptor quarter = brief.describe(image.view(), 30, 33, std::numbers::pi_v<float> / 2);
  for (std::size_t i = 0; i < 256; ++i) {
    const BriefPair& p = brief_pattern[i];
    EXPECT_EQ(upright.words[i / 64] >> (i % 64) & 1,
              image.at(30 + p.x0, 33 + p.y0) < image.at(30 + p.x1, 33 + p.y1));
    EXPECT_EQ(quarter.words[i / 64] >> (i % 64) & 1,
              image.at(30 - p.y0, 33 + p.x0) < image.at(30 - p.y1, 33 + p.x1));
  }
}

TEST(PatchAngle, PointsToTheBrightSide) {
  for (double direction : {0.0, 0.7, 2.0, -1.2, 3.0}) {
    Image<std::uint8_t> image(64, 64);
    for (int v = 0; v < 64; ++v)
      for (int u = 0; u < 64; ++u)
        image.at(u, v) = static_cast<std::uint8_t>(
            128 + 3 * (std::cos(direction) * (u - 30) + std::sin(direction) * (v - 33)) * 0.7);
    EXPECT_NEAR(patch_angle(image.view(), 30, 33), direction, 0.02);
  }
}

TEST(UndistortGrid, AgreesWithTheCamera) {
  Camera camera;
  camera.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  const UndistortGrid grid(camera);
  Rng rng(1, "undistort", 0);
  for (int i = 0; i < 500; ++i) {
    const double u = rng.uniform(0, 639), v = rng.uniform(0, 479);
    const Eigen::Vector2d expected = camera.undistort({u, v});
    EXPECT_LT((grid.at(static_cast<float>(u), static_cast<float>(v)).cast<double>() - expected).norm(), 0.01)
        << u << ", " << v;
  }
  EXPECT_EQ(UndistortGrid(Camera{}).at(17.5f, 3.25f), Eigen::Vector2f(17.5f, 3.25f));
}

}  // namespace
}  // namespace vsgraphs
