// Principal axes of small symmetric matrices.
#pragma once

#include <Eigen/Core>

#include "core/geometry/se3.h"

namespace vsgraphs {

// Unit eigenvector of the smallest eigenvalue; its sign is open.
Eigen::Vector3d weakest_axis(const Eigen::Matrix3d& symmetric);

double smallest_eigenvalue(const Eigen::Matrix2d& symmetric);
double smallest_eigenvalue6(const Matrix6d& symmetric);

// Projector onto the directions of motion that `information` (inverse covariance of a pose's tangent) knows worse than
// `max_sigma`, m or rad.
Matrix6d weak_directions(const Matrix6d& information, double max_sigma);

}  // namespace vsgraphs
