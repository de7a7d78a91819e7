#include "simulate/depth_sensors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

// A wall square to the camera in the middle of the image, grey without texture.
struct Wall {
  Camera camera;
  ExactDepth view;
  Image<Rgb> colour;

  Wall(const std::string& sensor, double z, float cosine = 1.0f) : camera(sensor_camera(sensor)) {
    const int w = camera.width, h = camera.height;
    view.depth = Image<std::uint16_t>(w, h, static_cast<std::uint16_t>(std::lround(z * camera.depth_scale)));
    view.label = Image<std::uint8_t>(w, h, static_cast<std::uint8_t>(SceneClass::wall));
    view.incidence = Image<float>(w, h, cosine);
    colour = Image<Rgb>(w, h, Rgb{150, 150, 150});
    view.colour = &colour;
  }
  Image<std::uint16_t> sensed(const std::string& sensor, int frame = 0) const {
    return sense(NoiseOptions::of(sensor), camera, frame, view);
  }
};

struct Figures {
  double bias_m = 0, sigma_m = 0, missing = 0;
};

// Over the middle of some frames; sigma is of a pixel from frame to frame.
Figures figures(const std::string& sensor, double z, float cosine = 1.0f) {
  const Wall wall(sensor, z, cosine);
  constexpr int frames = 8;
  std::vector<Image<std::uint16_t>> seen;
  for (int f = 0; f < frames; ++f) seen.push_back(wall.sensed(sensor, f));
  double sum = 0, spread = 0, missing = 0, count = 0, pixels = 0;
  for (int v = wall.camera.height / 4; v < 3 * wall.camera.height / 4; v += 3) {
    for (int u = wall.camera.width / 4; u < 3 * wall.camera.width / 4; u += 3) {
      double mean = 0, square = 0, n = 0;
      for (const auto& image : seen) {
        const double read = image.at(u, v) / wall.camera.depth_scale - z;
        if (image.at(u, v) == 0) missing += 1;
        if (image.at(u, v) > 0) mean += read, square += read * read, n += 1;
      }
      pixels += frames;
      if (n < frames - 1) continue;
      sum += mean / n, spread += (square - mean * mean / n) / (n - 1), count += 1;
    }
  }
  return {sum / count, std::sqrt(spread / count), missing / pixels};
}

TEST(DepthSensors, Kinect1SpreadsAsMeasured) {
  for (const double z : {1.0, 2.0, 3.5}) {
    const Figures f = figures("kinect1", z);
    EXPECT_NEAR(f.sigma_m, 1.425e-3 * z * z, 0.3 * 1.425e-3 * z * z) << z;  // Khoshelham and Elberink
    EXPECT_LT(std::abs(f.bias_m), 2e-3 * z * z) << z;
  }
  EXPECT_LT(figures("kinect1", 2).missing, 0.01);
  EXPECT_GT(figures("kinect1", 5.5).missing, 0.04);
  EXPECT_EQ(figures("kinect1", 0.4).missing, 1.0);
}

TEST(DepthSensors, Kinect2IsOffAlikeAndSpreadsLittle) {
  for (const double z : {1.0, 2.0, 4.0}) EXPECT_NEAR(figures("kinect2", z).bias_m, -0.018, 0.005) << z;
  EXPECT_NEAR(figures("kinect2", 1).sigma_m, 0.0011, 0.0005);
  EXPECT_NEAR(figures("kinect2", 4).sigma_m, 0.005, 0.002);
  EXPECT_EQ(figures("kinect2", 4.7).missing, 1.0);
}

TEST(DepthSensors, D435SpreadsWithTheSquareOfDistanceAndLosesBlankWallsFarOff) {
  for (const double z : {1.0, 2.0, 3.0}) {
    const double stated = z * z * 0.08 / (0.05 * 447);
    EXPECT_NEAR(figures("d435", z).sigma_m, stated, 0.3 * stated) << z;
  }
  EXPECT_LT(figures("d435", 1.5).missing, 0.02);
  EXPECT_GT(figures("d435", 5).missing, 0.2);
  Wall textured("d435", 5.0);  // what is seen well is matched without a pattern
  for (int v = 0; v < textured.camera.height; ++v)
    for (int u = 0; u < textured.camera.width; ++u)
      if ((u / 2 + v / 2) % 2) textured.colour.at(u, v) = {60, 60, 60};
  const Image<std::uint16_t> seen = textured.sensed("d435");
  EXPECT_LT(std::count(seen.pixels.begin(), seen.pixels.end(), 0),
            0.03 * static_cast<double>(seen.pixels.size()));
}

TEST(DepthSensors, TheTelephoneIsDenseAndSmooth) {
  EXPECT_NEAR(figures("iphone_lidar", 2).sigma_m, 0.007, 0.003);
  EXPECT_EQ(figures("iphone_lidar", 3).missing, 0.0);
  EXPECT_EQ(figures("iphone_lidar", 5.3).missing, 1.0);
  Wall step("iphone_lidar", 3.0);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 320; ++u) step.view.depth.at(u, v) = 5000;
  const Image<std::uint16_t> seen = step.sensed("iphone_lidar");
  int between = 0;
  for (int u = 300; u < 340; ++u) between += seen.at(u, 240) > 1.3 * 5000 && seen.at(u, 240) < 2.7 * 5000;
  EXPECT_GE(between, 4);  // an edge is a slope
}

TEST(DepthSensors, EdgesOfTimeOfFlightFlyAndOfStructuredLightThrowShadows) {
  Wall tof("kinect2", 3.0);
  for (int v = 0; v < tof.camera.height; ++v)
    for (int u = 0; u < 256; ++u) tof.view.depth.at(u, v) = 6000;
  int flying = 0;
  for (const std::uint16_t raw : tof.sensed("kinect2").pixels) flying += raw > 6500 && raw < 14000;
  EXPECT_GT(flying, tof.camera.height / 8);
  Wall light("kinect1", 3.0);
  for (int v = 0; v < 480; ++v)
    for (int u = 320; u < 640; ++u) light.view.depth.at(u, v) = 6000;
  const Image<std::uint16_t> seen = light.sensed("kinect1");
  const double shift = 0.075 * 525 * (1 / 1.2 - 1 / 3.0);  // of the projector's view, px
  int hidden = 0;
  for (int v = 0; v < 480; ++v)
    for (int u = 300; u < 320; ++u) hidden += seen.at(u, v) == 0;
  EXPECT_NEAR(hidden / 480.0, shift, 4);
}

TEST(DepthSensors, CornersLookRoundToTimeOfFlight) {
  Wall corner("kinect2", 2.0);
  Wall flat("kinect2", 2.0);
  const int w = corner.camera.width, middle = w / 2;
  for (int v = 0; v < corner.camera.height; ++v)
    for (int u = 0; u < w; ++u)  // two walls that meet 2 m away, at a right angle
      corner.view.depth.at(u, v) =
          static_cast<std::uint16_t>(5000 * 2.0 / (1 + std::abs(u - middle) / corner.camera.fx));
  const auto mean_at = [&](const Wall& wall, int u) {
    const Image<std::uint16_t> seen = wall.sensed("kinect2");
    double sum = 0;
    for (int v = 100; v < 320; ++v) sum += (seen.at(u, v) - wall.view.depth.at(u, v)) / 5000.0;
    return sum / 220;
  };
  EXPECT_GT(mean_at(corner, middle), mean_at(flat, middle) + 0.008);
}

TEST(DepthSensors, PanesAreSeenThroughOrNotAtAll) {
  for (const std::string& name : sensor_names()) {
    if (name == "classic" || name == "clean") continue;
    Wall wall(name, 3.0);
    wall.view.pane = Image<std::uint16_t>(wall.camera.width, wall.camera.height, 7500);
    wall.view.pane_incidence = Image<float>(wall.camera.width, wall.camera.height, 0.7f);
    int behind = 0, pane = 0, none = 0;
    const Image<std::uint16_t> seen = wall.sensed(name);
    for (const std::uint16_t raw : seen.pixels) {
      none += raw == 0;
      pane += raw > 6500 && raw < 8500;
      behind += raw > 13500;
    }
    const auto pixels = static_cast<double>(seen.pixels.size());
    EXPECT_GT(behind, 0.5 * pixels) << name;
    EXPECT_GT(pane + none, 0.04 * pixels) << name;
  }
}

TEST(DepthSensors, NothingBehindAPaneIsNotReadAsNearer) {
  for (const std::string name : {"kinect2", "iphone_lidar"}) {
    Wall wall(name, 0.0);
    wall.view.pane = Image<std::uint16_t>(wall.camera.width, wall.camera.height, 7500);
    wall.view.pane_incidence = Image<float>(wall.camera.width, wall.camera.height, 0.7f);
    for (const std::uint16_t raw : wall.sensed(name).pixels) ASSERT_TRUE(raw == 0 || raw > 6500) << name;
  }
}

TEST(DepthSensors, UnknownOnesAreNamedAgainstTheKnown) {
  try {
    static_cast<void>(NoiseOptions::of("kinect"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("kinect1, kinect2, d435"), std::string::npos);
  }
}

}  // namespace
}  // namespace vsgraphs
