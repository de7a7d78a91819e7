#include "simulate/lens.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/check.h"
#include "simulate/renderer.h"
#include "simulate/test_plan.h"

namespace vsgraphs {
namespace {

using Eigen::Vector2d;
using testing::small_camera;
using testing::two_rooms_plan;

TEST(Lens, KannalaBrandtIsItsFormula) {
  const Lens lens{"kannala_brandt", {0.02, -0.01, 0.003, -0.0004}};
  const double theta = 0.7, angle = 0.4;  // from the axis, about it
  const Vector2d ideal = std::tan(theta) * Vector2d(std::cos(angle), std::sin(angle));
  const double radius = theta + 0.02 * std::pow(theta, 3) - 0.01 * std::pow(theta, 5) +
                        0.003 * std::pow(theta, 7) - 0.0004 * std::pow(theta, 9);
  const Vector2d bent = lens.distort(ideal);
  EXPECT_NEAR(bent.x(), radius * std::cos(angle), 1e-12);
  EXPECT_NEAR(bent.y(), radius * std::sin(angle), 1e-12);
}

TEST(Lens, RationalIsItsFormula) {
  const Lens lens{"rational", {0.1, 0.02, 0.001, -0.002, 0.003, 0.2, 0.01, 0.004}};
  const double x = 0.3, y = -0.2, r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const double radial = (1 + 0.1 * r2 + 0.02 * r4 + 0.003 * r6) / (1 + 0.2 * r2 + 0.01 * r4 + 0.004 * r6);
  const Vector2d bent = lens.distort({x, y});
  EXPECT_NEAR(bent.x(), x * radial + 2 * 0.001 * x * y - 0.002 * (r2 + 2 * x * x), 1e-12);
  EXPECT_NEAR(bent.y(), y * radial + 0.001 * (r2 + 2 * y * y) + 2 * -0.002 * x * y, 1e-12);
}

TEST(Lens, RadialTangentialIsTheCamerasOfSequences) {
  const Lens lens{"radial_tangential", {-0.2, 0.05, 0.001, -0.0005, 0.01}};
  Camera camera = small_camera();
  camera.distortion = {-0.2, 0.05, 0.001, -0.0005, 0.01};
  const Vector2d pixel(20, 100), centre(camera.cx, camera.cy);
  const Vector2d bent = lens.distort((pixel - centre) / camera.fx) * camera.fx + centre;
  EXPECT_NEAR((bent - camera.distort(pixel)).norm(), 0, 1e-9);
}

TEST(Lens, EachIsUndone) {
  for (const Lens& lens :
       {Lens{"radial_tangential", {-0.2, 0.05, 0.001, -0.0005, 0.01}}, Lens{"kannala_brandt", {0.02, -0.01}},
        Lens{"rational", {0.1, 0.02, 0, 0, 0, 0.3}}}) {
    for (const Vector2d& p : {Vector2d(0, 0), Vector2d(0.5, -0.3), Vector2d(-0.6, 0.6)})
      EXPECT_NEAR((lens.undistort(lens.distort(p)) - p).norm(), 0, 1e-9) << lens.model;
  }
  EXPECT_THROW(Lens({"radial_tangential", {-0.8}}).undistort({2, 2}), InputError);
  EXPECT_THROW(Lens({"rational", {1, 2, 3, 4, 5, 6, 7, 8, 9}}).validate(), InputError);
}

// Depth of each pixel, taken back through the lens by hand, is what the pinhole shows there.
TEST(Lens, BentImagesShowWhatThePinholeShowsElsewhere) {
  const Scene scene = build_scene(two_rooms_plan());
  const Camera camera = small_camera();
  NoiseOptions bent = NoiseOptions::none();
  bent.lens = {"kannala_brandt", {0.03, -0.01}};
  const RenderedFrame a = Renderer(scene, camera, bent).render(10);
  const Eigen::Vector3d eye = a.world_from_camera.translation();
  int compared = 0;
  for (int v = 2; v < camera.height; v += 5) {
    for (int u = 2; u < camera.width; u += 5) {
      if (a.label.at(u, v) != static_cast<std::uint8_t>(SceneClass::floor)) continue;
      const Vector2d ray = bent.lens.undistort({(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy});
      const Eigen::Vector3d p = a.world_from_camera * (Eigen::Vector3d(ray.x(), ray.y(), 1) *
                                                       (a.depth.at(u, v) / camera.depth_scale));
      EXPECT_NEAR(p.z(), 0, 1e-3) << u << "," << v;  // the floor, exactly
      ++compared;
    }
  }
  EXPECT_GT(compared, 30);
  EXPECT_GT(eye.z(), 1);
}

TEST(Lens, StraightLensesChangeNothingMuch) {
  const Scene scene = build_scene(two_rooms_plan());
  NoiseOptions straight = NoiseOptions::none();
  straight.lens = {"radial_tangential", {}};
  const RenderedFrame a = Renderer(scene, small_camera(), straight).render(10),
                      b = Renderer(scene, small_camera(), NoiseOptions::none()).render(10);
  double sum = 0;
  int depths = 0;
  for (std::size_t i = 0; i < a.rgb.pixels.size(); ++i) {
    sum += std::abs(a.rgb.pixels[i].g - b.rgb.pixels[i].g);
    depths += std::abs(a.depth.pixels[i] - b.depth.pixels[i]) > 1;
  }
  EXPECT_LT(sum / static_cast<double>(a.rgb.pixels.size()), 2.0);
  EXPECT_LT(depths, 40);
}

}  // namespace
}  // namespace vsgraphs
