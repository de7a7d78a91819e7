// Rigid alignment of two point sets, without scale: Umeyama, "Least-Squares Estimation of Transformation Parameters
// Between Two Point Patterns", PAMI 1991 (the SVD of Arun et al. with the sign that excludes reflections).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/geometry/se3.h"

namespace vsgraphs {

// a_from_b minimising sum w |a - T b|^2. `weights`: one per pair, not negative, or empty: all 1. Nothing where the points do
// not fix a rotation: fewer than three, on one line or coincident, or values that are not finite.
std::optional<Se3> align_points(std::span<const Eigen::Vector3d> in_a, std::span<const Eigen::Vector3d> in_b,
                                std::span<const double> weights = {});

}  // namespace vsgraphs
