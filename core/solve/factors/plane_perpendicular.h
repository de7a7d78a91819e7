// Two planes stand at a right angle: residual = n_a . n_b / (sigma sqrt(pairs)). For pairs of walls, and for a wall and
// the ground it stands on: the latter, beyond the vS-Graphs paper, holds roll and pitch.
#pragma once

#include "core/solve/factors/dense_factor.h"
#include "core/solve/factors/plane_angle.h"

namespace vsgraphs {

class PlanePerpendicular final : public DenseFactor {
 public:
  PlanePerpendicular(int plane_a, int plane_b, const PlaneAngle& angle = {}, Huber robust = huber_1dof)
      : DenseFactor({{VariableKind::plane, plane_a}, {VariableKind::plane, plane_b}}, 1, robust),
        inv_sigma_(angle.inv_sigma()) {}

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    const Eigen::Vector3d& a = values.plane(variables()[0].index).normal;
    const Eigen::Vector3d& b = values.plane(variables()[1].index).normal;
    out.residual[0] = inv_sigma_ * a.dot(b);
    if (!with_jacobians) return true;
    out.jacobians[0] << inv_sigma_ * b.transpose() * tangent_basis(a), 0;
    out.jacobians[1] << inv_sigma_ * a.transpose() * tangent_basis(b), 0;
    return true;
  }

 private:
  double inv_sigma_;
};

}  // namespace vsgraphs
