#include "core/geometry/plane_estimate.h"

#include <Eigen/LU>

namespace vsgraphs {

PlaneEstimate PlaneEstimate::transformed(const Se3& target_from_source) const {
  PlaneEstimate moved{plane.transformed(target_from_source), {}};
  Eigen::Matrix3d change = Eigen::Matrix3d::Identity();  // of tangent coordinates; orthogonal
  change.topLeftCorner<2, 2>() = tangent_basis(moved.plane.normal).transpose() *
                                 target_from_source.rotation() * tangent_basis(plane.normal);
  moved.information = change * information * change.transpose();
  return moved;
}

Eigen::Matrix<double, 3, 6> plane_by_frame(const AnchoredPlane& plane) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian.topLeftCorner<2, 3>().setZero();
  jacobian.topRightCorner<2, 3>() = tangent_basis(plane.normal).transpose() * skew(plane.normal);
  jacobian.bottomLeftCorner<1, 3>() = plane.normal.transpose();
  jacobian.bottomRightCorner<1, 3>() = plane.anchor.cross(plane.normal).transpose();
  return jacobian;
}

PlaneEstimate PlaneEstimate::inflated(const FrameTolerance& frame) const {
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(frame.sigma_m * frame.sigma_m),
      Eigen::Vector3d::Constant(frame.sigma_rad * frame.sigma_rad);
  const Eigen::Matrix<double, 3, 6> by_frame = plane_by_frame(plane);
  const Eigen::Matrix3d covariance = by_frame * variance.asDiagonal() * by_frame.transpose();
  const Eigen::Matrix3d left =
      (Eigen::Matrix3d::Identity() + information * covariance).inverse() * information;
  return {plane, 0.5 * (left + left.transpose())};
}

}  // namespace vsgraphs
