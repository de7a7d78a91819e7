#include "core/tracking/frame_extractor.h"

#include <gtest/gtest.h>

#include "core/base/check.h"
#include "core/vision/test_painted_wall.h"

namespace vsgraphs {
namespace {

using namespace test;

// A painted wall 2 m ahead.
class FrameExtractorTest : public ::testing::Test {
 protected:
  RgbdFrame frame() const {
    RgbdFrame frame;
    frame.index = 4;
    frame.timestamp_s = 1.5;
    frame.depth.metres = depth_.view();
    return frame;
  }

  Image<std::uint8_t> grey_ = painted_wall(painted_view_width, 800, Rng(7, "painted_wall", 0));
  Image<float> depth_{painted_view_width, painted_view_height, 2.0F};
  FrameExtractor extractor_{OrbOptions{}, painted_wall_camera(30)};
};

TEST_F(FrameExtractorTest, FeaturesHaveDepthAndNoLandmarksYet) {
  RgbdFrame seen = frame();
  seen.grey = grey_.view();
  const FrameState now = extractor_.extract(seen);
  EXPECT_EQ(now.index, 4);
  EXPECT_EQ(now.timestamp_s, 1.5);
  EXPECT_GT(now.features->size(), 100);
  EXPECT_EQ(now.features_with_depth(), now.features->size());
  EXPECT_EQ(now.landmarks.size(), static_cast<std::size_t>(now.features->size()));
  EXPECT_EQ(now.matched_landmarks(), 0);
  EXPECT_FALSE(now.pose.keyframe.valid());
  EXPECT_NEAR(now.surface->at(20, 15).point.z(), 2.0F, 1e-4F);
}

TEST_F(FrameExtractorTest, ColourServesAsWellAsGrey) {
  Image<Rgb> colour(painted_view_width, painted_view_height);
  for (int v = 0; v < painted_view_height; ++v)
    for (int u = 0; u < painted_view_width; ++u)
      colour.at(u, v) = {grey_.at(u, v), grey_.at(u, v), grey_.at(u, v)};
  RgbdFrame seen = frame(), grey = frame();
  seen.colour = colour.view();
  grey.grey = grey_.view();
  EXPECT_EQ(extractor_.extract(seen).features->descriptors(),
            extractor_.extract(grey).features->descriptors());
}

TEST_F(FrameExtractorTest, ImagesOfAnotherSizeAreRefused) {
  const Image<std::uint8_t> small(painted_view_width / 2, painted_view_height, 0);
  RgbdFrame seen = frame();
  seen.grey = small.view();
  EXPECT_THROW(extractor_.extract(seen), InputError);
}

}  // namespace
}  // namespace vsgraphs
