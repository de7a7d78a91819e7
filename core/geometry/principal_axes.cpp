#include "core/geometry/principal_axes.h"

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

Matrix6d weak_directions(const Matrix6d& information, double max_sigma) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(information);
  Matrix6d projector = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (axes.eigenvalues()[i] * max_sigma * max_sigma >= 1) continue;
    projector += axes.eigenvectors().col(i) * axes.eigenvectors().col(i).transpose();
  }
  return projector;
}

}  // namespace vsgraphs
