// The interface of every relation between poses and structure. A new relation is one file with a factor derived from this
// and one line that adds it to BundleProblem::factors.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/solve/robust.h"
#include "core/solve/structure_variables.h"

namespace vsgraphs {

inline constexpr int max_factor_rows = 12;

// Whitened residual and one Jacobian per variable, in the order of DenseFactor::variables(). Storage is inline and reused.
struct FactorRows {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_factor_rows, 1> residual;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_factor_rows, 6>> jacobians;
};

// The values a factor is evaluated at; owned by the solver, valid during evaluate().
struct VariableValues {
  const std::vector<Se3>& poses;  // world_from_camera
  const StructureVariables& structures;

  const Se3& pose(int i) const { return poses[static_cast<std::size_t>(i)]; }
  const AnchoredPlane& plane(int i) const { return structures.planes[static_cast<std::size_t>(i)]; }
  const Eigen::Vector3d& centroid(int i) const { return structures.centroids[static_cast<std::size_t>(i)]; }
  const Se3& marker(int i) const { return structures.markers[static_cast<std::size_t>(i)]; }
  // A pose or a marker: both are rigid transforms into the world.
  const Se3& frame(VariableRef v) const {
    return v.kind == VariableKind::marker ? marker(v.index) : pose(v.index);
  }
};

class DenseFactor {
 public:
  // `variables`: each at most once. `rows`: 1..max_factor_rows. `robust` acts on the norm of the whole residual.
  DenseFactor(std::vector<VariableRef> variables, int rows, Huber robust = {})
      : variables_(std::move(variables)), rows_(rows), robust_(robust) {}
  virtual ~DenseFactor() = default;
  DenseFactor(const DenseFactor&) = delete;
  DenseFactor& operator=(const DenseFactor&) = delete;
  DenseFactor(DenseFactor&&) = delete;
  DenseFactor& operator=(DenseFactor&&) = delete;

  const std::vector<VariableRef>& variables() const { return variables_; }
  int rows() const { return rows_; }
  const Huber& robust() const { return robust_; }

  // Fills out.residual and, when `with_jacobians`, out.jacobians, all of the announced sizes already; tangent vectors as
  // the variables' retractions take them. Returns false where the relation says nothing (the factor then has no cost).
  // Pure: no state, no allocation.
  virtual bool evaluate(const VariableValues& values, bool with_jacobians, FactorRows& out) const = 0;

  // Sizes `out` for this factor.
  void resize(FactorRows& out) const {
    out.residual.resize(rows_);
    if (out.jacobians.size() < variables_.size()) out.jacobians.resize(variables_.size());
    for (std::size_t i = 0; i < variables_.size(); ++i)
      out.jacobians[i].resize(rows_, dof_of(variables_[i].kind));
  }

 private:
  std::vector<VariableRef> variables_;
  int rows_;
  Huber robust_;
};

}  // namespace vsgraphs
