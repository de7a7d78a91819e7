#include "core/geometry/camera.h"

#include <Eigen/LU>
#include <cmath>

#include "core/geometry/lens_jacobian.h"

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
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d error = distort(p) - distorted_px;
    if (error.squaredNorm() < 1e-16) break;
    const Eigen::Matrix2d jacobian = distort_jacobian(*this, p);
    if (std::abs(jacobian.determinant()) < 1e-6) break;
    p -= jacobian.inverse() * error;
  }
  return p.allFinite() ? p : distorted_px;  // a corner that the model says nothing of
}

}  // namespace vsgraphs
