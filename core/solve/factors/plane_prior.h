// Prior on a plane of the world: residual = S (pi_hat [-] pi). Stands for what keyframes outside the window saw of it
// (see condense_observations).
#pragma once

#include "core/solve/factors/dense_factor.h"
#include "core/solve/factors/plane_difference.h"

namespace vsgraphs {

class PlanePrior final : public DenseFactor {
 public:
  // `plane`: index into the problem's planes. `known`: in the world.
  PlanePrior(int plane, const PlaneEstimate& known, Huber robust = {})
      : DenseFactor({{VariableKind::plane, plane}}, 3, robust), known_(known) {}

  bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const override {
    Eigen::Matrix3d by_plane;
    out.residual = known_.residual(values.plane(variables()[0].index), with_jacobians ? &by_plane : nullptr);
    if (with_jacobians) out.jacobians[0] = by_plane;
    return true;
  }

 private:
  PlaneDifference known_;
};

}  // namespace vsgraphs
