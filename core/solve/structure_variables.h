// The structural unknowns of the joint problem and how each moves: planes, centroids of rooms and floors, markers.
// Together with the keyframe poses they are the variables of the reduced system; landmarks are eliminated from it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/geometry/plane.h"
#include "core/geometry/se3.h"

namespace vsgraphs {

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
  std::vector<AnchoredPlane> planes;       // in the world
  std::vector<Eigen::Vector3d> centroids;  // rooms and floors, m, in the world
  std::vector<Se3> markers;                // world_from_marker
  // Same lengths as above, or empty: nothing fixed.
  std::vector<std::uint8_t> plane_fixed, centroid_fixed, marker_fixed;
};

}  // namespace vsgraphs
