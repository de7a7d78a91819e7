// How large a saved value may be. Far beyond any map, and small enough that whatever is worked out from it stays a number, and
// that voxels and cells can be counted with an int.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/geometry/plane.h"
#include "core/geometry/se3.h"

namespace vsgraphs {

inline constexpr double most_metres = 1e5;
inline constexpr double most_information = 1e18;  // of a link or a patch: a micrometre's, of many readings

// False for what is no number.
inline bool within(double value, double most) { return std::abs(value) <= most; }
template <typename Derived>
bool within(const Eigen::MatrixBase<Derived>& values, double most) {
  return (values.derived().array().abs() <= static_cast<typename Derived::Scalar>(most)).all();
}

inline bool is_unit(const Eigen::Vector3d& vector) { return within(vector.squaredNorm() - 1, 1e-3); }

// A rotation and a place.
inline bool is_pose(const Se3& pose) {
  const Eigen::Matrix3d& r = pose.rotation();
  return within(r, 2) && within(r.transpose() * r - Eigen::Matrix3d::Identity(), 1e-3) &&
         within(pose.translation(), most_metres);
}

inline bool is_plane(const AnchoredPlane& plane) {
  return is_unit(plane.normal) && within(plane.anchor, most_metres) && within(plane.offset_m, most_metres);
}

}  // namespace vsgraphs
