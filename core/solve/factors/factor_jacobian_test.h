// Checks every Jacobian of a dense factor against differences of its residual. Tests only.
#pragma once

#include <vector>

#include "core/base/rng.h"
#include "core/solve/factors/dense_factor.h"
#include "core/solve/factors/jacobian_test.h"

namespace vsgraphs {

// Translation and rotation evenly spread up to these, per axis.
inline Vector6d tangent(Rng& rng, double metres, double radians) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = (i < 3 ? metres : radians) * rng.uniform(-1, 1);
  return xi;
}

// Moves variable `v` by the tangent vector `delta`, as the solver does.
inline void move_variable(VariableRef v, const Eigen::VectorXd& delta, std::vector<Se3>& poses,
                          StructureVariables& structures) {
  const auto i = static_cast<std::size_t>(v.index);
  if (v.kind == VariableKind::pose) poses[i] = poses[i].retract(delta);
  if (v.kind == VariableKind::plane) structures.planes[i] = structures.planes[i].retract(delta);
  if (v.kind == VariableKind::centroid) structures.centroids[i] += delta;
  if (v.kind == VariableKind::marker) structures.markers[i] = structures.markers[i].retract(delta);
}

inline Eigen::VectorXd residual_of(const DenseFactor& factor, const std::vector<Se3>& poses,
                                   const StructureVariables& structures) {
  FactorRows rows;
  factor.resize(rows);
  EXPECT_TRUE(factor.evaluate({poses, structures}, false, rows));
  return rows.residual;
}

inline void expect_factor_jacobians(const DenseFactor& factor, const std::vector<Se3>& poses,
                                    const StructureVariables& structures, double step = 1e-3) {
  FactorRows rows;
  factor.resize(rows);
  // What the solver's reused storage may hold.
  for (auto& jacobian : rows.jacobians) jacobian.setConstant(1e9);
  ASSERT_TRUE(factor.evaluate({poses, structures}, true, rows));
  EXPECT_EQ(rows.residual, residual_of(factor, poses, structures)) << "with and without Jacobians";
  for (std::size_t v = 0; v < factor.variables().size(); ++v) {
    const auto at = [&](const Eigen::VectorXd& delta) {
      std::vector<Se3> moved_poses = poses;
      StructureVariables moved = structures;
      move_variable(factor.variables()[v], delta, moved_poses, moved);
      return residual_of(factor, moved_poses, moved);
    };
    SCOPED_TRACE("variable " + std::to_string(v));
    expect_jacobian(rows.jacobians[v], at, 1e-7, step);
  }
}

}  // namespace vsgraphs
