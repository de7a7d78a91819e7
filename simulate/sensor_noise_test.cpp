#include "simulate/sensor_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vsgraphs {
namespace {

constexpr int width = 320, height = 240;

Camera camera() {
  Camera c;
  c.width = width, c.height = height;
  c.cx = 159.5, c.cy = 119.5;
  return c;
}

// A wall square to the camera, seen as one class.
struct Wall {
  Image<std::uint16_t> depth;
  Image<std::uint8_t> label;
  Image<float> incidence;
  explicit Wall(double z, SceneClass kind = SceneClass::wall, float cosine = 1.0f)
      : depth(width, height, static_cast<std::uint16_t>(std::lround(z * 5000))),
        label(width, height, static_cast<std::uint8_t>(kind)),
        incidence(width, height, cosine) {}
  Image<std::uint16_t> sensed(const NoiseOptions& noise, int frame = 0) const {
    return sense_depth(noise, camera(), frame, depth, label, incidence);
  }
};

double hole_share(const Image<std::uint16_t>& depth) {
  return static_cast<double>(std::count(depth.pixels.begin(), depth.pixels.end(), 0)) /
         static_cast<double>(depth.pixels.size());
}

NoiseOptions only(bool quantisation, bool holes) {
  NoiseOptions noise = NoiseOptions::none();
  noise.depth_quantisation = quantisation;
  noise.depth_holes = holes;
  return noise;
}

TEST(SensorNoise, DisparitiesAreWholeSteps) {
  const NoiseOptions noise = only(true, false);
  const double bf = noise.baseline_m * camera().fx;
  for (const std::uint16_t raw : Wall(2.7).sensed(noise).pixels) {
    const double steps = bf * 5000 / raw / noise.disparity_step_px;
    EXPECT_NEAR(steps, std::round(steps), 0.5 * steps / raw + 1e-9);  // rounding to the unit of depth
  }
}

TEST(SensorNoise, DisparityErrorHasTheStatedSpreadAndNoBias) {
  NoiseOptions noise = only(true, false);
  noise.disparity_step_px = 1e-3;  // steps too fine to matter
  const double bf = noise.baseline_m * camera().fx;
  double sum = 0, sum2 = 0, product = 0;
  int n = 0;
  for (int frame = 0; frame < 10; ++frame) {
    const Image<std::uint16_t> seen = Wall(1.5).sensed(noise, frame);
    const auto error = [&](int u, int v) { return bf * 5000 / seen.at(u, v) - bf / 1.5; };
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u + 1 < width; ++u, ++n) {
        sum += error(u, v), sum2 += error(u, v) * error(u, v);
        product += error(u, v) * error(u + 1, v);
      }
    }
  }
  EXPECT_NEAR(sum / n, 0, 0.005);
  EXPECT_NEAR(std::sqrt(sum2 / n), noise.disparity_sigma_px, 0.1 * noise.disparity_sigma_px);
  EXPECT_GT(product / sum2, 0.8);  // neighbours err alike
}

TEST(SensorNoise, HolesGrowWithDistanceGrazingAnglesAndGlass) {
  const NoiseOptions noise = only(false, true);
  EXPECT_LT(hole_share(Wall(2.0).sensed(noise)), 0.002);
  const double at_4_2 = hole_share(Wall(4.2).sensed(noise)), at_5_5 = hole_share(Wall(5.5).sensed(noise));
  EXPECT_NEAR(at_4_2, 0.025, 0.012);
  EXPECT_NEAR(at_5_5, 0.125, 0.03);
  EXPECT_EQ(hole_share(Wall(6.1).sensed(noise)), 1.0);
  EXPECT_EQ(hole_share(Wall(0.3).sensed(noise)), 1.0);
  EXPECT_LT(hole_share(Wall(2.0, SceneClass::wall, std::cos(1.3f)).sensed(noise)), 0.01);  // 74 deg
  EXPECT_GT(hole_share(Wall(2.0, SceneClass::wall, std::cos(1.5f)).sensed(noise)), 0.4);   // 86 deg
  const double glass = hole_share(Wall(2.0, SceneClass::window).sensed(noise));
  EXPECT_GT(glass, 0.3);
  EXPECT_LT(glass, 0.95);
}

TEST(SensorNoise, EdgesOfDepthHaveNoReadings) {
  Wall wall(3.0);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < 160; ++u) wall.depth.at(u, v) = 1.2 * 5000;
  const Image<std::uint16_t> seen = wall.sensed(only(false, true));
  int missing = 0;
  for (int v = 0; v < height; ++v) missing += (seen.at(159, v) == 0) + (seen.at(160, v) == 0);
  EXPECT_EQ(missing, 2 * height);
  for (int v = 0; v < height; ++v)
    EXPECT_EQ(seen.at(100, v) == 0 && seen.at(101, v) == 0 && seen.at(104, v) == 0, false);
}

TEST(SensorNoise, SlantedPlanesAreNotEdges) {
  Wall wall(3.0);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      wall.depth.at(u, v) = static_cast<std::uint16_t>(5000 / (0.3 + 0.001 * u));
  EXPECT_LT(hole_share(wall.sensed(only(false, true))), 0.004);
}

TEST(SensorNoise, ImageNoiseHasTheStatedSize) {
  NoiseOptions noise = NoiseOptions::none();
  Image<Rgb> clean(width, height), noisy(width, height);
  const std::vector<float> light(3u * width * height, 480.0f);
  develop(noise, 0, 0.25f, light, clean);
  for (const Rgb c : clean.pixels) ASSERT_EQ(c, (Rgb{120, 120, 120}));
  noise.image_noise = true;
  develop(noise, 0, 0.25f, light, noisy);
  double sum = 0, sum2 = 0;
  for (const Rgb c : noisy.pixels) sum += c.g - 120.0, sum2 += (c.g - 120.0) * (c.g - 120.0);
  const double n = width * height;
  EXPECT_NEAR(sum / n, 0, 0.1);
  EXPECT_NEAR(std::sqrt(sum2 / n), noise.image_sigma, 0.15 * noise.image_sigma);
}

TEST(SensorNoise, ExposureWandersSlowlyWithinItsAmplitude) {
  const NoiseOptions noise;
  float low = 2, high = 0;
  for (double t = 0; t < 60; t += 0.1) {
    const float gain = exposure_gain(noise, t);
    EXPECT_LT(std::abs(exposure_gain(noise, t + 0.033) - gain), 0.01);
    low = std::min(low, gain), high = std::max(high, gain);
  }
  EXPECT_GT(low, 1 - 1.001 * noise.exposure_amplitude);
  EXPECT_LT(high, 1 + 1.001 * noise.exposure_amplitude);
  EXPECT_GT(high - low, 0.5 * noise.exposure_amplitude);
}

}  // namespace
}  // namespace vsgraphs
