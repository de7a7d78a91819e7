#include "core/vision/fast_corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/vision/test_images.h"

namespace vsgraphs {
namespace {

constexpr std::array<std::array<int, 2>, 16> circle{{{0, -3},
                                                     {1, -3},
                                                     {2, -2},
                                                     {3, -1},
                                                     {3, 0},
                                                     {3, 1},
                                                     {2, 2},
                                                     {1, 3},
                                                     {0, 3},
                                                     {-1, 3},
                                                     {-2, 2},
                                                     {-3, 1},
                                                     {-3, 0},
                                                     {-3, -1},
                                                     {-2, -2},
                                                     {-1, -3}}};

// The definition, word by word: the largest t such that nine contiguous pixels differ by at least t.
int score_by_definition(const Image<std::uint8_t>& image, int x, int y) {
  int best = 0;
  for (int sign : {1, -1}) {
    for (std::size_t start = 0; start < 16; ++start) {
      int smallest = 255;
      for (std::size_t k = 0; k < 9; ++k) {
        const auto& d = circle[(start + k) % 16];
        smallest = std::min(smallest, sign * (image.at(x + d[0], y + d[1]) - image.at(x, y)));
      }
      best = std::max(best, smallest);
    }
  }
  return best;
}

std::vector<Corner> corners_by_definition(const Image<std::uint8_t>& image, int threshold, int border) {
  Image<std::uint8_t> scores(image.width, image.height, 0);
  for (int y = border; y < image.height - border; ++y)
    for (int x = border; x < image.width - border; ++x) {
      const int score = score_by_definition(image, x, y);
      scores.at(x, y) = static_cast<std::uint8_t>(score > threshold ? score : 0);
    }
  std::vector<Corner> corners;
  for (int y = border; y < image.height - border; ++y)
    for (int x = border; x < image.width - border; ++x) {
      const int s = scores.at(x, y);
      bool peak = s > 0;
      for (int k = 0; k < 9 && peak; ++k) {
        const int other = scores.at(x + k % 3 - 1, y + k / 3 - 1);
        peak = k < 4 ? s > other : s >= other;
      }
      if (peak)
        corners.push_back(
            {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), static_cast<std::uint8_t>(s)});
    }
  return corners;
}

TEST(FastCorners, FindsExactlyWhatTheDefinitionSays) {
  for (int width : {70, 96, 131}) {
    const Image<std::uint8_t> image = test::textured_image(width, 90, static_cast<std::uint64_t>(width));
    FastCorners fast;
    std::vector<Corner> found;
    for (int threshold : {7, 20}) {
      fast.detect(image.view(), threshold, 16, found);
      const std::vector<Corner> expected = corners_by_definition(image, threshold, 16);
      ASSERT_GT(expected.size(), 5u);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].x, expected[i].x);
        EXPECT_EQ(found[i].y, expected[i].y);
        EXPECT_EQ(found[i].score, expected[i].score);
      }
    }
  }
}

TEST(FastCorners, ABlankOrTooSmallImageHasNone) {
  FastCorners fast;
  std::vector<Corner> found{{1, 1, 1}};
  fast.detect(Image<std::uint8_t>(100, 100, 77).view(), 7, 16, found);
  EXPECT_TRUE(found.empty());
  fast.detect(test::textured_image(60, 60, 3).view(), 7, 16, found);
  EXPECT_TRUE(found.empty());
}

TEST(FastCorners, AWhiteSquaresCornersAreFoundAndItsEdgesAreNot) {
  Image<std::uint8_t> image(128, 128, 10);
  for (int v = 40; v < 80; ++v)
    for (int u = 40; u < 80; ++u) image.at(u, v) = 200;
  FastCorners fast;
  std::vector<Corner> found;
  fast.detect(image.view(), 20, 16, found);
  ASSERT_EQ(found.size(), 4u);
  for (const Corner& c : found) {
    EXPECT_LE(std::min(std::abs(c.x - 40), std::abs(c.x - 79)), 2);
    EXPECT_LE(std::min(std::abs(c.y - 40), std::abs(c.y - 79)), 2);
    EXPECT_EQ(c.score, 190);
  }
}

// At the rim of the searched area a corner's neighbour may score higher and still not be a corner: the position
// then must not run away (it once left the image).
TEST(FastCorners, NoPixelIsMovedByMoreThanHalf) {
  const Image<std::uint8_t> image = test::textured_image(200, 150, 3);
  for (int y = 6; y + 7 < image.height; ++y) {
    for (int x = 6; x + 7 < image.width; ++x) {
      const SubpixelShift shift =
          refine(image.view(), {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), 50});
      ASSERT_LE(std::abs(shift.x), 0.5f) << x << ' ' << y;
      ASSERT_LE(std::abs(shift.y), 0.5f) << x << ' ' << y;
    }
  }
}

}  // namespace
}  // namespace vsgraphs
