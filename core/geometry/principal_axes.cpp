#include "core/geometry/principal_axes.h"

#include <Eigen/Eigenvalues>

namespace vsgraphs {

Eigen::Vector3d weakest_axis(const Eigen::Matrix3d& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric).eigenvectors().col(0);
}

double smallest_eigenvalue(const Eigen::Matrix2d& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace vsgraphs
