#include "core/geometry/camera.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

// The TUM benchmark's lens (freiburg1): strong radial terms that partly cancel.
Camera freiburg1() {
  Camera camera;
  camera.fx = 517.306408, camera.fy = 516.469215, camera.cx = 318.643040, camera.cy = 255.313989;
  camera.distortion = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314};
  return camera;
}

TEST(Camera, ProjectionAndItsInverse) {
  const Camera camera;
  const Eigen::Vector3d p(0.3, -0.2, 1.7);
  const Eigen::Vector2d px = camera.project(p);
  EXPECT_LT((camera.unproject(px.x(), px.y(), p.z()) - p).norm(), 1e-14);
  EXPECT_LT((camera.project({0, 0, 3}) - Eigen::Vector2d(camera.cx, camera.cy)).norm(), 1e-12);
}

TEST(Camera, UndistortInvertsDistortOverTheWholeImage) {
  const Camera camera = freiburg1();
  for (int v = 0; v < camera.height; v += 16) {
    for (int u = 0; u < camera.width; u += 16) {
      const Eigen::Vector2d seen(u, v);
      EXPECT_LT((camera.distort(camera.undistort(seen)) - seen).norm(), 1e-6) << u << " " << v;
    }
  }
  const Eigen::Vector2d corner(0, 0);
  EXPECT_GT((camera.undistort(corner) - corner).norm(), 1.0) << "this lens bends its corners";
}

TEST(Camera, WithoutDistortionNothingChanges) {
  const Camera camera;
  EXPECT_FALSE(camera.distorted());
  const Eigen::Vector2d px(12.3, 456.7);
  EXPECT_EQ(camera.undistort(px), px);
  EXPECT_LT((camera.distort(px) - px).norm(), 1e-12);
}

TEST(Camera, DistortFollowsThePublishedModel) {
  Camera camera;
  camera.distortion = {0.1, 0, 0.01, 0, 0};
  // x = 0.5, y = 0.25: r2 = 0.3125, radial = 1.03125, tangential (2 p1 x y, p1 (r2 + 2 y^2)).
  const Eigen::Vector2d px = camera.project({0.5, 0.25, 1});
  const Eigen::Vector2d expected(camera.fx * (0.5 * 1.03125 + 2 * 0.01 * 0.125) + camera.cx,
                                 camera.fy * (0.25 * 1.03125 + 0.01 * (0.3125 + 0.125)) + camera.cy);
  EXPECT_LT((camera.distort(px) - expected).norm(), 1e-10);
}

TEST(Camera, DepthNoiseIsThePublishedCurve) {
  const DepthNoise noise;
  EXPECT_NEAR(noise.sigma_m(0.4), 0.0012, 1e-12);
  EXPECT_NEAR(noise.sigma_m(2.4), 0.0012 + 0.0019 * 4, 1e-12);
}

}  // namespace
}  // namespace vsgraphs
