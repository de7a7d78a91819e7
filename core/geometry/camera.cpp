#include "core/geometry/camera.h"

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "core/base/check.h"

namespace vsgraphs {

Eigen::Vector2d Camera::distort(const Eigen::Vector2d& undistorted_px) const {
  const double x = (undistorted_px.x() - cx) / fx;
  const double y = (undistorted_px.y() - cy) / fy;
  const auto [k1, k2, p1, p2, k3] = distortion;
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  return {fx * xd + cx, fy * yd + cy};
}

Eigen::Vector2d Camera::undistort(const Eigen::Vector2d& distorted_px) const {
  if (!distorted()) return distorted_px;
  // Newton on distort(p) = target with a numerical 2x2 Jacobian: converges in 3-4 steps over the image of every
  // lens in common use, where the plain fixed-point iteration diverges at strong corners.
  Eigen::Vector2d p = distorted_px;
  constexpr double step_px = 1e-3;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d error = distort(p) - distorted_px;
    if (error.squaredNorm() < 1e-16) break;
    Eigen::Matrix2d jacobian;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d e = step_px * Eigen::Vector2d::Unit(k);
      jacobian.col(k) = (distort(p + e) - distort(p - e)) / (2 * step_px);
    }
    if (std::abs(jacobian.determinant()) < 1e-6) break;
    p -= jacobian.inverse() * error;
  }
  return p;
}

void Camera::validate() const {
  const auto positive = [](double value, const char* name) {
    require_input(
        std::isfinite(value) && value > 0,
        std::string("camera: ") + name + " must be a positive number, not " + std::to_string(value));
  };
  require_input(width >= 64 && height >= 64 && width <= 8192 && height <= 8192,
                "camera: width and height must lie in 64..8192 px, not " + std::to_string(width) + "x" +
                    std::to_string(height));
  positive(fx, "fx");
  positive(fy, "fy");
  positive(fps, "fps");
  positive(depth_scale, "depth_scale");
  positive(depth_min_m, "depth_min_m");
  positive(depth_max_m, "depth_max_m");
  positive(depth_noise.offset_m, "depth_noise.offset_m");
  require_input(std::isfinite(depth_noise.scale_per_m) && depth_noise.scale_per_m >= 0 &&
                    std::isfinite(depth_noise.onset_m),
                "camera: depth_noise needs a scale of zero or more and a finite onset");
  require_input(std::isfinite(depth_noise.alignment_m) && depth_noise.alignment_m >= 0,
                "camera: depth_noise.alignment_m must be zero or more");
  require_input(std::isfinite(cx) && std::isfinite(cy) && contains(cx, cy),
                "camera: the principal point (cx, cy) lies outside the image");
  require_input(depth_max_m > depth_min_m, "camera: depth_max_m must exceed depth_min_m");
  for (double k : distortion)
    require_input(std::isfinite(k), "camera: distortion holds a value that is not finite");
}

}  // namespace vsgraphs
