// The structural unknowns of the joint problem and how each moves: planes, centroids of rooms and floors, markers.
// Together with the keyframe poses they are the variables of the reduced system; landmarks are eliminated from it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/geometry/se3.h"

namespace vsgraphs {

// Columns span the tangent plane of the unit vector n; a continuous function of n except at one point per sign of z
// (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017).
Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& n);

// Plane n . (x - anchor) + offset = 0. The offset is measured at an anchor near the plane's observed extent: measured at
// a far origin, a small turn of the normal would act as a large shift and couple the two in the solver.
struct PlaneVariable {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, towards the side that saw the plane
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();   // m, in the world; constant during a solve
  double offset_m = 0;

  static constexpr int dof = 3;
  double signed_distance(const Eigen::Vector3d& point) const { return normal.dot(point - anchor) + offset_m; }
  // d of the form n.x + d = 0.
  double d() const { return offset_m - normal.dot(anchor); }
  // (two angles in the tangent basis of the normal along the great circle, metres of offset).
  PlaneVariable retract(const Eigen::Vector3d& delta) const;
  // The delta that retracts this plane to `other`, which must have the same anchor and a normal within pi.
  Eigen::Vector3d local(const PlaneVariable& other) const;
};

enum class VariableKind : std::uint8_t { pose, plane, centroid, marker };

struct VariableRef {
  VariableKind kind = VariableKind::pose;
  int index = 0;
  bool operator==(const VariableRef&) const = default;
};

// Degrees of freedom of a kind: 6 for poses and markers, 3 for planes and centroids.
constexpr int dof_of(VariableKind kind) {
  return kind == VariableKind::pose || kind == VariableKind::marker ? 6 : 3;
}

struct StructureVariables {
  std::vector<PlaneVariable> planes;
  std::vector<Eigen::Vector3d> centroids;  // rooms and floors, m, in the world
  std::vector<Se3> markers;                // world_from_marker
  // Same lengths as above, or empty: nothing fixed.
  std::vector<std::uint8_t> plane_fixed, centroid_fixed, marker_fixed;
};

}  // namespace vsgraphs
