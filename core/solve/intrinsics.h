// What the solvers need of a camera: the ideal pinhole, without the lens (observations are undistorted pixels),
// and the weight of a depth reading.
#pragma once

#include <Eigen/Core>

#include "core/geometry/camera.h"

namespace vsgraphs {

struct Intrinsics {
  double fx = 525.0, fy = 525.0, cx = 319.5, cy = 239.5;  // px

  static Intrinsics of(const Camera& camera) { return {camera.fx, camera.fy, camera.cx, camera.cy}; }
  Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
  }
  Eigen::Vector3d unproject(double u, double v, double depth_m) const {
    return {(u - cx) / fx * depth_m, (v - cy) / fy * depth_m, depth_m};
  }
  // Ray through the pixel with z = 1.
  Eigen::Vector3d bearing(double u, double v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0}; }
};

// 1 / standard deviation of the inverse depth (m) of a feature's reading at depth_m: sigma(1/z) = sigma(z) / z^2.
inline double inv_sigma_of_inverse_depth(const DepthNoise& noise, double depth_m) {
  return depth_m * depth_m / noise.feature_sigma_m(depth_m);
}

}  // namespace vsgraphs
