// What the factors on planes share: the whitened difference of a plane to an estimate of it, with its derivatives.
#pragma once

#include <Eigen/Core>

#include "core/geometry/plane_estimate.h"

namespace vsgraphs {

// S with S'S = information, for singular information too (eigenvalues that rounding took below 0 count as 0).
Eigen::Matrix3d plane_sqrt_information(const Eigen::Matrix3d& information);

// The great-circle angles from the unit vector `from` to the unit vector `to`, in the tangent basis of `from` (as
// AnchoredPlane::local). `by_to` (may be null) receives the derivative for moves of `to` on the sphere. Exact at 0; at
// half a turn, where every direction is as good, the angle is pi along the first.
Eigen::Vector2d tilt_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             Eigen::Matrix<double, 2, 3>* by_to);

// The derivatives by the plane's own (tilts, offset): of its normal, which the offset does not move, and of its offset
// measured at `point`.
struct PlaneByTangent {
  Eigen::Matrix<double, 3, 2> normal;
  Eigen::RowVector3d offset;

  PlaneByTangent(const AnchoredPlane& plane, const Eigen::Vector3d& point)
      : normal(tangent_basis(plane.normal)) {
    offset << (point - plane.anchor).transpose() * normal, 1;
  }
};

// An estimate made ready for being compared with many planes: residual = S (estimate [-] plane), the plane's offset
// measured at the estimate's anchor.
class PlaneDifference {
 public:
  explicit PlaneDifference(const PlaneEstimate& estimate)
      : plane_(estimate.plane), sqrt_information_(plane_sqrt_information(estimate.information)) {}

  const AnchoredPlane& plane() const { return plane_; }
  const Eigen::Matrix3d& sqrt_information() const { return sqrt_information_; }

  // Not whitened: of `normal` and `offset_m` (at the anchor), in the estimate's frame. `by_normal` may be null.
  Eigen::Vector3d local(const Eigen::Vector3d& normal, double offset_m,
                        Eigen::Matrix<double, 2, 3>* by_normal) const {
    Eigen::Vector3d difference;
    difference << tilt_between(plane_.normal, normal, by_normal), offset_m - plane_.offset_m;
    return difference;
  }

  // The residual of a plane given in the estimate's own frame; `by_plane` (may be null) its derivative by the plane's
  // tangent.
  Eigen::Vector3d residual(const AnchoredPlane& plane, Eigen::Matrix3d* by_plane) const {
    Eigen::Matrix<double, 2, 3> tilt;
    const Eigen::Vector3d difference =
        local(plane.normal, plane.signed_distance(plane_.anchor), by_plane ? &tilt : nullptr);
    if (by_plane) {
      const PlaneByTangent by_tangent(plane, plane_.anchor);
      *by_plane << tilt * by_tangent.normal, Eigen::Vector2d::Zero(), by_tangent.offset;
      *by_plane = sqrt_information_ * *by_plane;
    }
    return sqrt_information_ * difference;
  }

 private:
  AnchoredPlane plane_;
  Eigen::Matrix3d sqrt_information_;
};

}  // namespace vsgraphs
