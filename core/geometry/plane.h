// Planes with a minimal parameterisation: three numbers move one, two angles of the normal and an offset.
#pragma once

#include <Eigen/Core>

#include "core/base/fields.h"
#include "core/geometry/se3.h"

namespace vsgraphs {

// Columns span the tangent plane of the unit vector n; a continuous function of n except at one point per sign of z
// (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017).
Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& n);

// Plane n . (x - anchor) + offset = 0. The offset is measured at an anchor near the plane's observed extent: measured at
// a far origin, a small turn of the normal would act as a large shift and couple the two in a solver.
struct AnchoredPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, towards the side that saw the plane
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();   // m; constant during a solve
  double offset_m = 0;

  static constexpr int dof = 3;
  double signed_distance(const Eigen::Vector3d& point) const { return normal.dot(point - anchor) + offset_m; }
  // d of the form n.x + d = 0.
  double d() const { return offset_m - normal.dot(anchor); }
  // Foot of the perpendicular from `point`.
  Eigen::Vector3d project(const Eigen::Vector3d& point) const {
    return point - signed_distance(point) * normal;
  }
  // (two angles in the tangent basis of the normal along the great circle, metres of offset).
  AnchoredPlane retract(const Eigen::Vector3d& delta) const;
  // The delta that retracts this plane to `other`, which must have the same anchor. Opposite normals: one of the
  // half turns between them.
  Eigen::Vector3d local(const AnchoredPlane& other) const;
  // The same plane with its offset measured at `point`.
  AnchoredPlane anchored_at(const Eigen::Vector3d& point) const {
    return {normal, point, signed_distance(point)};
  }
  // The same plane in another frame.
  AnchoredPlane transformed(const Se3& target_from_source) const {
    return {target_from_source.rotation() * normal, target_from_source * anchor, offset_m};
  }
};
template <FieldsOf<AnchoredPlane> T>
void visit_fields(T& v, auto& field) {
  auto& [normal, anchor, offset_m] = v;
  field(normal, anchor, offset_m);
}

}  // namespace vsgraphs
