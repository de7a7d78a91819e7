// A plane together with how well it is known.
#pragma once

#include <Eigen/Core>

#include "core/geometry/plane.h"
#include "core/geometry/se3.h"

namespace vsgraphs {

// An uncertain rigid motion: independent errors of the same size in every direction.
struct FrameTolerance {
  double sigma_m = 0;
  double sigma_rad = 0;
};

struct PlaneEstimate {
  AnchoredPlane plane;
  // Inverse covariance of (two tilts in rad, offset in m) as plane.retract takes them. Positive semidefinite: points on a
  // line know one tilt and the offset.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();

  // The same knowledge in another frame. The information follows the tangent basis, which does not turn with the frame.
  PlaneEstimate transformed(const Se3& target_from_source) const;
  // What is left of it if the frame it is given in is itself off by an unknown motion: information (I + Lambda C)^-1
  // Lambda with C the motion's covariance carried to the plane, for singular information too. Serves the error of a
  // keyframe's pose and what all readings of one frame have in common (depth and colour taken apart in time).
  PlaneEstimate inflated(const FrameTolerance& frame) const;
};

// The change of (tilts, offset) of a plane when its frame moves, T * exp(rho, phi), seen from the frame: 3x6.
Eigen::Matrix<double, 3, 6> plane_by_frame(const AnchoredPlane& plane);

}  // namespace vsgraphs
