// Prior on a pose or marker: residual = S log(prior^-1 T), S'S the information in T's own frame (rho, phi).
#pragma once

#include "core/geometry/se3_jacobian.h"
#include "core/solve/factors/dense_factor.h"

namespace vsgraphs {

class PosePrior final : public DenseFactor {
 public:
  PosePrior(VariableRef frame, const Se3& prior, const Matrix6d& sqrt_information, Huber robust = {})
      : DenseFactor({frame}, 6, robust),
        prior_inverse_(prior.inverse()),
        sqrt_information_(sqrt_information) {}

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const Vector6d error = (prior_inverse_ * values.frame(variables()[0])).log();
    out.residual = sqrt_information_ * error;
    if (with_jacobians) out.jacobians[0] = sqrt_information_ * se3_right_jacobian_inverse(error);
    return true;
  }

 private:
  Se3 prior_inverse_;
  Matrix6d sqrt_information_;
};

}  // namespace vsgraphs
