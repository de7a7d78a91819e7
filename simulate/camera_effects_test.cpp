// What a camera does besides measuring depth: shutters, delays, mounts, exposure.
#include <gtest/gtest.h>

#include <cmath>

#include "simulate/renderer.h"
#include "simulate/sensor_noise.h"
#include "simulate/test_plan.h"

namespace vsgraphs {
namespace {

using testing::small_camera;

// Turns quickly on the spot before walls with boards.
Plan turning_plan() {
  Plan plan = testing::two_rooms_plan();
  plan.path.waypoints[1].at = {1.3, 2};
  plan.path.waypoints[1].yaw_deg = 170;
  plan.path.turn_rate = 60;
  plan.posters.push_back({"A", 0, 2.5, 1.4, 1.2, 0.9, "board", 1});
  plan.posters.push_back({"A", 2, 2.5, 1.4, 1.2, 0.9, "board", 1});
  return plan;
}

TEST(CameraEffects, RollingRowsAreThoseOfThePoseAtTheirTime) {
  const Camera camera = small_camera();
  Plan plan = turning_plan();
  NoiseOptions rolling = NoiseOptions::none();
  rolling.rolling_shutter_s = 0.0595;  // half a millisecond a row
  Plan fine = plan;
  fine.fps = 240;
  const Scene scene = build_scene(plan), often = build_scene(fine);
  const int index = 60;
  const RenderedFrame bent = Renderer(scene, camera, rolling).render(index);
  Renderer still(often, camera, NoiseOptions::none());
  const double start = index / plan.fps;
  for (int band = 0; band < 15; band += 7) {
    const int row = 8 * band + 3;
    const double later = rolling.rolling_shutter_s * ((8 * band + 3.0) / (camera.height - 1) - 0.5);
    const RenderedFrame at_its_time = still.render(static_cast<int>(std::lround((start + later) * fine.fps)));
    const RenderedFrame at_the_middle = still.render(static_cast<int>(std::lround(start * fine.fps)));
    double same = 0, other = 0;
    for (int u = 0; u < camera.width; ++u) {
      same += std::abs(bent.rgb.at(u, row).g - at_its_time.rgb.at(u, row).g);
      other += std::abs(bent.rgb.at(u, row).g - at_the_middle.rgb.at(u, row).g);
    }
    if (band == 7)
      EXPECT_LT(same, 1.5 * camera.width);
    else
      EXPECT_LT(same, 0.4 * other) << "row " << row;
  }
}

TEST(CameraEffects, DepthComesLaterByItsDelay) {
  Plan plan = turning_plan();
  NoiseOptions late = NoiseOptions::none();
  late.depth_delay_s = 2 / plan.fps;
  const Scene scene = build_scene(plan);
  Renderer delayed(scene, small_camera(), late), exact(scene, small_camera(), NoiseOptions::none());
  const RenderedFrame a = delayed.render(50), b = exact.render(52), now = exact.render(50);
  EXPECT_EQ(a.depth.pixels, b.depth.pixels);
  EXPECT_NE(a.depth.pixels, now.depth.pixels);
  EXPECT_EQ(a.rgb.pixels, now.rgb.pixels);
  EXPECT_EQ(a.label.pixels, now.label.pixels);  // the truth is that of the colour image
}

TEST(CameraEffects, MisregisteredDepthIsShiftedByPixels) {
  const Scene scene = build_scene(turning_plan());
  NoiseOptions shifted = NoiseOptions::none();
  shifted.misregistration_u_px = 3, shifted.misregistration_v_px = -2;
  const RenderedFrame a = Renderer(scene, small_camera(), shifted).render(50),
                      b = Renderer(scene, small_camera(), NoiseOptions::none()).render(50);
  int differing = 0, compared = 0;
  for (int v = 10; v < 110; ++v)
    for (int u = 10; u < 150; ++u, ++compared)
      differing += std::abs(a.depth.at(u, v) - b.depth.at(u + 3, v - 2)) > 1;
  EXPECT_LT(differing, compared / 200);
}

TEST(CameraEffects, DepthFromBesideTheColourHasParallax) {
  const Scene scene = build_scene(turning_plan());
  const Camera camera = small_camera();
  NoiseOptions beside = NoiseOptions::none();
  beside.misregistration_baseline_m = 0.06;
  const RenderedFrame a = Renderer(scene, camera, beside).render(50),
                      b = Renderer(scene, camera, NoiseOptions::none()).render(50);
  int compared = 0, off = 0, off_unmoved = 0;
  double least = 1e9, most = 0;
  for (int v = 10; v < 110; ++v) {
    for (int u = 10; u < 130; ++u) {
      const double z = a.depth.at(u, v) / camera.depth_scale;
      const double shift = camera.fx * beside.misregistration_baseline_m / z;
      const int x = u + static_cast<int>(std::lround(shift));
      if (z <= 0 || x >= 150) continue;
      least = std::min(least, shift), most = std::max(most, shift);
      const double slack = 0.012 * z * camera.depth_scale;
      ++compared;
      off += std::abs(a.depth.at(u, v) - b.depth.at(x, v)) > slack;
      off_unmoved += std::abs(a.depth.at(u, v) - b.depth.at(u, v)) > slack;
    }
  }
  EXPECT_GT(most, 1.3 * least);  // near things are off by more
  EXPECT_LT(off, compared / 25);
  EXPECT_GT(off_unmoved, 2 * off);
}

TEST(CameraEffects, TheBorderHasNoDepth) {
  const Scene scene = build_scene(turning_plan());
  NoiseOptions cut = NoiseOptions::of("kinect1");
  cut.border_right = 0.25, cut.border_top = 0.1;
  const RenderedFrame frame = Renderer(scene, small_camera(), cut).render(50);
  for (int v = 0; v < 120; ++v) {
    for (int u = v < 12 ? 0 : 120; u < 160; ++u) ASSERT_EQ(frame.depth.at(u, v), 0) << u << " " << v;
  }
  EXPECT_GT(frame.depth.at(60, 60), 0);
}

TEST(CameraEffects, SoftOpticsSpreadAnEdgeAndKeepItsLight) {
  constexpr int w = 40, h = 9;
  std::vector<float> light(3 * w * h, 0.0f);
  for (int v = 0; v < h; ++v)
    for (int k = 0; k < 3; ++k)
      for (int u = w / 2; u < w; ++u) light[static_cast<std::size_t>((3 * v + k) * w + u)] = 200;
  NoiseOptions options = NoiseOptions::none();
  Image<Rgb> sharp(w, h), soft(w, h);
  develop(options, 0, 1, light, sharp);
  options.softness_px = 0.8;
  develop(options, 0, 1, light, soft);
  EXPECT_EQ(sharp.at(w / 2 - 1, 4).r, 0);
  EXPECT_EQ(sharp.at(w / 2, 4).r, 200);
  EXPECT_NEAR(soft.at(w / 2 - 1, 4).g, 53, 3);  // a Gaussian's share half a pixel and more from the edge
  EXPECT_EQ(soft.at(w / 2 - 1, 4).r + soft.at(w / 2, 4).r, 200);
  EXPECT_EQ(soft.at(0, 0).b, 0);
  EXPECT_EQ(soft.at(w - 1, h - 1).b, 200);
}

TEST(CameraEffects, UpsideDownIsTheImageTurned) {
  const Scene scene = build_scene(turning_plan());
  NoiseOptions hung = NoiseOptions::none();
  hung.roll_deg = 180;
  const Camera camera = small_camera();
  const RenderedFrame a = Renderer(scene, camera, hung).render(50),
                      b = Renderer(scene, camera, NoiseOptions::none()).render(50);
  int differing = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      differing += a.label.at(u, v) != b.label.at(camera.width - 1 - u, camera.height - 1 - v);
  EXPECT_LT(differing, camera.width * camera.height / 200);
  EXPECT_NEAR((a.world_from_camera.rotation().col(0) + b.world_from_camera.rotation().col(0)).norm(), 0,
              1e-9);
  EXPECT_NEAR((a.world_from_camera.rotation().col(2) - b.world_from_camera.rotation().col(2)).norm(), 0,
              1e-9);
}

double mean_of(const Image<Rgb>& image) {
  double sum = 0;
  for (const Rgb c : image.pixels) sum += c.g;
  return sum / static_cast<double>(image.pixels.size());
}

TEST(CameraEffects, AutomaticExposureEvensOutDarkRoomsAndPaysWithBlurAndNoise) {
  Plan dark_plan = turning_plan();
  for (RoomPlan& room : dark_plan.rooms) room.brightness = 0.2;
  const Scene light = build_scene(turning_plan()), dark = build_scene(dark_plan);
  NoiseOptions fixed = NoiseOptions::none(), automatic = NoiseOptions::none();
  automatic.auto_exposure = true;
  const double before = mean_of(Renderer(dark, small_camera(), fixed).render(0).rgb) /
                        mean_of(Renderer(light, small_camera(), fixed).render(0).rgb);
  const double after = mean_of(Renderer(dark, small_camera(), automatic).render(0).rgb) /
                       mean_of(Renderer(light, small_camera(), automatic).render(0).rgb);
  EXPECT_LT(before, 0.5);
  EXPECT_GT(after, 0.8);
  NoiseOptions noisy = automatic;
  noisy.image_noise = true;
  const auto noise_of = [&](const Scene& scene) {
    const RenderedFrame a = Renderer(scene, small_camera(), noisy).render(0),
                        b = Renderer(scene, small_camera(), automatic).render(0);
    double sum = 0;
    for (std::size_t i = 0; i < a.rgb.pixels.size(); ++i)
      sum += std::abs(a.rgb.pixels[i].g - b.rgb.pixels[i].g);
    return sum;
  };
  EXPECT_GT(noise_of(dark), 1.1 * noise_of(light));
}

}  // namespace
}  // namespace vsgraphs
