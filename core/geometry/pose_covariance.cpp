#include "core/geometry/pose_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/base/check.h"
#include "core/geometry/se3_jacobian.h"

namespace vsgraphs {

bool is_covariance(const Matrix6d& matrix) {
  constexpr double most = 1e6, rounding = 1e-9;
  if (!(matrix.cwiseAbs().maxCoeff() <= most) || !matrix.allFinite()) return false;
  if (!(matrix - matrix.transpose()).isZero(rounding)) return false;
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[0] >=
         -rounding;
}

Matrix6d isotropic_covariance(double sigma_m, double sigma_rad) {
  Vector6d variances;
  variances.head<3>().setConstant(sigma_m * sigma_m);
  variances.tail<3>().setConstant(sigma_rad * sigma_rad);
  return variances.asDiagonal();
}

Matrix6d information_of(const Matrix6d& covariance) {
  const Eigen::LLT<Matrix6d> factor(covariance);
  VSG_INVARIANT(factor.info() == Eigen::Success);
  const Matrix6d inverse = factor.solve(Matrix6d::Identity());
  return 0.5 * (inverse + inverse.transpose());
}

Matrix6d covariance_of(const Matrix6d& information) {
  return information_of(information + 1e-6 * Matrix6d::Identity());
}

Matrix6d compose_covariance(const Matrix6d& of_a_from_b, const Se3& b_from_c, const Matrix6d& of_b_from_c) {
  const Matrix6d carry = se3_adjoint(b_from_c.inverse());
  const Matrix6d composed = carry * of_a_from_b * carry.transpose() + of_b_from_c;
  return 0.5 * (composed + composed.transpose());
}

Matrix6d inverted_covariance(const Se3& a_from_b, const Matrix6d& of_a_from_b) {
  const Matrix6d carry = se3_adjoint(a_from_b);
  return carry * of_a_from_b * carry.transpose();
}

Matrix6d floored(const Matrix6d& covariance, const Matrix6d& floor) {
  const Vector6d sigmas = floor.diagonal().cwiseSqrt(), per_sigma = sigmas.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(per_sigma.asDiagonal() * covariance *
                                                     per_sigma.asDiagonal());
  const Vector6d raised = axes.eigenvalues().cwiseMax(1.0);
  const Matrix6d half = sigmas.asDiagonal() * axes.eigenvectors();
  return half * raised.asDiagonal() * half.transpose();
}

double sigmas_of(const Vector6d& error, const Matrix6d& covariance) {
  const Eigen::LLT<Matrix6d> factor(covariance);
  VSG_INVARIANT(factor.info() == Eigen::Success);
  return factor.matrixL().solve(error).norm();
}

}  // namespace vsgraphs
