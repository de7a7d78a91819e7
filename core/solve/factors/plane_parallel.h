// Two planes are parallel, whichever way they face: residual = n_a x n_b / (sigma sqrt(pairs)), the sine of the angle
// between them. It has the length of B_a' n_b with B_a spanning the tangent plane of n_a, but no basis to choose.
// The vS-Graphs paper takes 1 - |n_a . n_b|, which is quartic in the angle near 0 once squared and all but forceless:
// chi^2 0.0145 at 5 deg where the perpendicular term has 7.6. Ours is linear in the angle.
#pragma once

#include "core/solve/factors/dense_factor.h"
#include "core/solve/factors/plane_angle.h"

namespace vsgraphs {

class PlaneParallel final : public DenseFactor {
 public:
  PlaneParallel(int plane_a, int plane_b, const PlaneAngle& angle = {}, Huber robust = huber_2dof)
      : DenseFactor({{VariableKind::plane, plane_a}, {VariableKind::plane, plane_b}}, 3, robust),
        inv_sigma_(angle.inv_sigma()) {}

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const Eigen::Vector3d& a = values.plane(variables()[0].index).normal;
    const Eigen::Vector3d& b = values.plane(variables()[1].index).normal;
    out.residual = inv_sigma_ * a.cross(b);
    if (!with_jacobians) return true;
    out.jacobians[0].leftCols<2>() = -inv_sigma_ * skew(b) * tangent_basis(a);
    out.jacobians[1].leftCols<2>() = inv_sigma_ * skew(a) * tangent_basis(b);
    out.jacobians[0].col(2).setZero();
    out.jacobians[1].col(2).setZero();
    return true;
  }

 private:
  double inv_sigma_;
};

}  // namespace vsgraphs
