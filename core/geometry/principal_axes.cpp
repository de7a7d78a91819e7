#include "core/geometry/principal_axes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace vsgraphs {

Eigen::Vector3d weakest_axis(const Eigen::Matrix3d& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric).eigenvectors().col(0);
}

double smallest_eigenvalue(const Eigen::Matrix2d& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

double smallest_eigenvalue6(const Matrix6d& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

Matrix6d inverse6(const Matrix6d& positive) { return positive.ldlt().solve(Matrix6d::Identity()); }

}  // namespace vsgraphs
