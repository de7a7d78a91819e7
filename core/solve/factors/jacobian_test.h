// Checks an analytic Jacobian against central differences. Tests only.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>

namespace vsgraphs {

// residual_at(delta): the residual with the variable moved by the tangent vector delta.
inline Eigen::MatrixXd numeric_jacobian(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residual_at, int dof, double step = 1e-5) {
  const Eigen::VectorXd at_zero = residual_at(Eigen::VectorXd::Zero(dof));
  Eigen::MatrixXd jacobian(at_zero.size(), dof);
  for (int k = 0; k < dof; ++k) {
    const Eigen::VectorXd e = step * Eigen::VectorXd::Unit(dof, k);
    // Fourth order: lets the step be large enough for the differences to keep their digits.
    jacobian.col(k) =
        (8 * (residual_at(e) - residual_at(-e)) - (residual_at(2 * e) - residual_at(-2 * e))) / (12 * step);
  }
  return jacobian;
}

inline void expect_jacobian(const Eigen::MatrixXd& analytic,
                            const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residual_at,
                            double relative_tolerance = 1e-6, double step = 1e-5) {
  const Eigen::MatrixXd numeric = numeric_jacobian(residual_at, static_cast<int>(analytic.cols()), step);
  ASSERT_EQ(analytic.rows(), numeric.rows());
  const double scale = std::max(1.0, numeric.cwiseAbs().maxCoeff());
  EXPECT_LE((analytic - numeric).cwiseAbs().maxCoeff(), relative_tolerance * scale)
      << "analytic\n"
      << analytic << "\nnumeric\n"
      << numeric;
}

}  // namespace vsgraphs
