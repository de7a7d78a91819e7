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
    const AnchoredPlane& plane = values.plane(variables()[0].index);
    const Eigen::Vector3d& anchor = known_.plane().anchor;
    Eigen::Matrix<double, 2, 3> tilt;
    out.residual = known_.sqrt_information() * known_.local(plane.normal, plane.signed_distance(anchor),
                                                            with_jacobians ? &tilt : nullptr);
    if (!with_jacobians) return true;
    const PlaneByTangent by_tangent(plane, anchor);
    Eigen::Matrix3d by_plane;
    by_plane << tilt * by_tangent.normal, Eigen::Vector2d::Zero(), by_tangent.offset;
    out.jacobians[0] = known_.sqrt_information() * by_plane;
    return true;
  }

 private:
  PlaneDifference known_;
};

}  // namespace vsgraphs
