// Principal axes and inverses of small symmetric matrices.
#pragma once

#include <Eigen/Core>

#include "core/geometry/se3.h"

namespace vsgraphs {

// Unit eigenvector of the smallest eigenvalue; its sign is open.
Eigen::Vector3d weakest_axis(const Eigen::Matrix3d& symmetric);

double smallest_eigenvalue(const Eigen::Matrix2d& symmetric);
double smallest_eigenvalue6(const Matrix6d& symmetric);

// Inverse of a symmetric, positive definite matrix: covariance from information, and back.
Matrix6d inverse6(const Matrix6d& positive);

}  // namespace vsgraphs
