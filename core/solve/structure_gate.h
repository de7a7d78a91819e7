// Which pairs of planes are held parallel or perpendicular: only those that nearly are. A trapezoid room must not be bent
// square, and a pair near the limit must not come and go with the noise.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace vsgraphs {

// Hysteresis on the deviation from the ideal angle.
struct AngleGate {
  double enter_rad = 6 * std::numbers::pi / 180;
  double leave_rad = 10 * std::numbers::pi / 180;

  // Whether a pair that was held or not until now is held from here on.
  bool holds(bool held_before, double deviation_rad) const {
    return deviation_rad < (held_before ? leave_rad : enter_rad);
  }
};

// Angles of unit normals from parallel (whichever way they face) and from perpendicular, rad in [0, pi / 2].
inline double deviation_from_parallel_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}
inline double deviation_from_perpendicular_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(std::abs(a.dot(b)), a.cross(b).norm());
}

}  // namespace vsgraphs
