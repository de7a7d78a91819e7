// Principal axes of small symmetric matrices.
#pragma once

#include <Eigen/Core>

namespace vsgraphs {

// Unit eigenvector of the smallest eigenvalue; its sign is open.
Eigen::Vector3d weakest_axis(const Eigen::Matrix3d& symmetric);

double smallest_eigenvalue(const Eigen::Matrix2d& symmetric);

}  // namespace vsgraphs
