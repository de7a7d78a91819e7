// The derivative of a lens's model, numerically.
#pragma once

#include <Eigen/Core>

#include "core/geometry/camera.h"

namespace vsgraphs {

// Of Camera::distort() at an undistorted pixel, px per px.
inline Eigen::Matrix2d distort_jacobian(const Camera& camera, const Eigen::Vector2d& undistorted_px) {
  constexpr double step_px = 1e-3;
  Eigen::Matrix2d jacobian;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d e = step_px * Eigen::Vector2d::Unit(k);
    jacobian.col(k) =
        (camera.distort(undistorted_px + e) - camera.distort(undistorted_px - e)) / (2 * step_px);
  }
  return jacobian;
}

}  // namespace vsgraphs
