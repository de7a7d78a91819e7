// RGB-D reprojection: a point in the world seen from world_from_camera at an undistorted pixel (u, v), with the inverse
// of its depth where there is a reading. p_c = R^T (p_w - t); residual = predicted - measured, whitened.
// Jacobians: pose perturbed on the right, T * exp(rho, phi), so dp_c = -rho + p_c x phi.
#pragma once

#include <Eigen/Core>

#include "core/geometry/se3.h"
#include "core/solve/intrinsics.h"

namespace vsgraphs {

// Nearer than this, or behind the camera, a point has no usable projection and the factor is invalid, m.
inline constexpr double min_projection_depth_m = 0.05;

struct ReprojectionMeasurement {
  double u = 0, v = 0;                 // undistorted px
  double inverse_depth = 0;            // 1/m; 0 or less: no reading
  double inv_sigma_px = 1;             // 1/px, of the pyramid level
  double inv_sigma_inverse_depth = 0;  // m; see inv_sigma_of_inverse_depth
  bool has_depth() const { return inverse_depth > 0; }
};

template <int Rows>
struct ReprojectionRows {
  Eigen::Matrix<double, Rows, 1> residual;
  Eigen::Matrix<double, Rows, 6> by_pose;
  Eigen::Matrix<double, Rows, 3> by_point;
};

// Rows = 3: (u, v, inverse depth); Rows = 2: (u, v). Returns false, with `out` untouched, for a point too near to or
// behind the camera plane.
template <int Rows>
bool reprojection(const Intrinsics& k, const Se3& world_from_camera, const Eigen::Vector3d& point_in_world,
                  const ReprojectionMeasurement& m, ReprojectionRows<Rows>& out) {
  static_assert(Rows == 2 || Rows == 3);
  const Eigen::Matrix3d camera_from_world = world_from_camera.rotation().transpose();
  const Eigen::Vector3d p = camera_from_world * (point_in_world - world_from_camera.translation());
  if (!(p.z() >= min_projection_depth_m)) return false;
  const double iz = 1.0 / p.z();
  const double x = p.x() * iz, y = p.y() * iz;
  const double wu = k.fx * m.inv_sigma_px, wv = k.fy * m.inv_sigma_px;
  out.residual[0] = wu * x + (k.cx - m.u) * m.inv_sigma_px;
  out.residual[1] = wv * y + (k.cy - m.v) * m.inv_sigma_px;
  Eigen::Matrix<double, Rows, 3> by_camera_point;
  by_camera_point.row(0) << wu * iz, 0, -wu * x * iz;
  by_camera_point.row(1) << 0, wv * iz, -wv * y * iz;
  if constexpr (Rows == 3) {
    out.residual[2] = (iz - m.inverse_depth) * m.inv_sigma_inverse_depth;
    by_camera_point.row(2) << 0, 0, -iz * iz * m.inv_sigma_inverse_depth;
  }
  out.by_pose.template leftCols<3>() = -by_camera_point;
  out.by_pose.template rightCols<3>() = by_camera_point * skew(p);
  out.by_point = by_camera_point * camera_from_world;
  return true;
}

}  // namespace vsgraphs
