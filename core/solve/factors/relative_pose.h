// Relative pose of two frames (poses or markers): residual = S log(a_from_b^-1 Ta^-1 Tb), S'S the information in b's
// frame. Serves pose graphs, odometry and marker observations.
#pragma once

#include "core/geometry/se3_jacobian.h"
#include "core/solve/factors/dense_factor.h"

namespace vsgraphs {

class RelativePose : public DenseFactor {
 public:
  RelativePose(VariableRef a, VariableRef b, const Se3& a_from_b, const Matrix6d& sqrt_information,
               Huber robust = {})
      : DenseFactor({a, b}, 6, robust), b_from_a_(a_from_b.inverse()), sqrt_information_(sqrt_information) {}

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const Se3 a_from_b = values.frame(variables()[0]).inverse() * values.frame(variables()[1]);
    const Vector6d error = (b_from_a_ * a_from_b).log();
    out.residual = sqrt_information_ * error;
    if (with_jacobians) {
      const Matrix6d by_b = sqrt_information_ * se3_right_jacobian_inverse(error);
      out.jacobians[0] = -by_b * se3_adjoint(a_from_b.inverse());
      out.jacobians[1] = by_b;
    }
    return true;
  }

 private:
  Se3 b_from_a_;
  Matrix6d sqrt_information_;
};

}  // namespace vsgraphs
