#include "core/vision/grey_pyramid.h"

#include <gtest/gtest.h>

#include <array>

#include "core/base/check.h"
#include "core/vision/grey.h"
#include "core/vision/test_images.h"

namespace vsgraphs {
namespace {

TEST(ToGrey, WeighsTheColours) {
  Image<Rgb> colour(4, 2);
  colour.at(0, 0) = {255, 255, 255};
  colour.at(1, 0) = {255, 0, 0};
  colour.at(2, 1) = {0, 255, 0};
  colour.at(3, 1) = {0, 0, 255};
  const Image<std::uint8_t> grey = to_grey(colour.view());
  EXPECT_EQ(grey.at(0, 0), 255);
  EXPECT_NEAR(grey.at(1, 0), 0.299 * 255, 1);
  EXPECT_NEAR(grey.at(2, 1), 0.587 * 255, 1);
  EXPECT_NEAR(grey.at(3, 1), 0.114 * 255, 1);
  EXPECT_EQ(grey.at(0, 1), 0);
  EXPECT_THROW(to_grey(ImageView<Rgb>{}), InputError);
}

TEST(ToGrey, FollowsTheStride) {
  Image<Rgb> colour(8, 4);
  colour.at(2, 1) = {9, 9, 9};
  ImageView<Rgb> part{&colour.at(1, 1), 5, 2, 8};
  EXPECT_EQ(to_grey(part).at(1, 0), 9);
}

TEST(GreyPyramid, LevelsAreTheSameSceneAlignedByTheEdges) {
  // A plane of grey values stays one: level pixel x shows level-0 position (x + 0.5) * W/w - 0.5.
  Image<std::uint8_t> image(320, 240);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      image.at(u, v) = static_cast<std::uint8_t>(std::lround(20 + 0.4 * u + 0.3 * v));
  GreyPyramid pyramid({8, 1.2}, 320, 240);
  pyramid.build(image.view());
  for (int i = 0; i < pyramid.levels(); ++i) {
    const ImageView<std::uint8_t>& level = pyramid.level(i);
    EXPECT_EQ(level.width, std::lround(320 / std::pow(1.2, i)));
    for (int y = 4; y < level.height - 4; ++y) {
      for (int x = 4; x < level.width - 4; ++x) {
        const double u = (x + 0.5) * 320 / level.width - 0.5, v = (y + 0.5) * 240 / level.height - 0.5;
        ASSERT_NEAR(level.at(x, y), 20 + 0.4 * u + 0.3 * v, 2.0) << "level " << i << " at " << x << ", " << y;
        ASSERT_NEAR(pyramid.blurred(i).at(x, y), 20 + 0.4 * u + 0.3 * v, 2.0);
      }
    }
  }
}

TEST(GreyPyramid, AConstantImageStaysConstantToTheLastPixel) {
  for (const std::uint8_t value : std::array<std::uint8_t, 4>{0, 1, 128, 255}) {
    const Image<std::uint8_t> image(100, 75, value);
    GreyPyramid pyramid({5, 1.7}, 100, 75);
    pyramid.build(image.view());
    for (int i = 0; i < pyramid.levels(); ++i)
      for (int y = 0; y < pyramid.level(i).height; ++y)
        for (int x = 0; x < pyramid.level(i).width; ++x) {
          ASSERT_EQ(pyramid.level(i).at(x, y), value);
          ASSERT_EQ(pyramid.blurred(i).at(x, y), value);
        }
  }
}

TEST(GreyPyramid, BlurIsTheExactKernel) {
  const Image<std::uint8_t> image = test::textured_image(90, 70, 5);
  GreyPyramid pyramid({1, 1.2}, 90, 70);
  pyramid.build(image.view());
  const int weights[7] = {1, 2, 3, 4, 3, 2, 1};
  for (int y = 0; y < 70; ++y) {
    for (int x = 0; x < 90; ++x) {
      int sum = 128;
      for (int k = 0; k < 49; ++k) {
        const int u = std::clamp(x + k % 7 - 3, 0, 89), v = std::clamp(y + k / 7 - 3, 0, 69);
        sum += weights[k % 7] * weights[k / 7] * image.at(u, v);
      }
      ASSERT_EQ(pyramid.blurred(0).at(x, y), sum >> 8) << x << ", " << y;
    }
  }
}

TEST(ScalePyramid, PredictsTheLevelFromTheDepth) {
  const ScalePyramid scales{8, 1.2};
  EXPECT_DOUBLE_EQ(scales.level_sigma_px(2), 1.44);
  EXPECT_EQ(scales.predict_level(2.0, 2.0, 3), 3);
  EXPECT_EQ(scales.predict_level(2.0 / 1.44, 2.0, 3), 5) << "nearer: larger in the image, a coarser level";
  EXPECT_EQ(scales.predict_level(2.0 * 1.2, 2.0, 3), 2);
  EXPECT_EQ(scales.predict_level(0.1, 2.0, 3), 7);
  EXPECT_EQ(scales.predict_level(50.0, 2.0, 3), 0);
}

}  // namespace
}  // namespace vsgraphs
