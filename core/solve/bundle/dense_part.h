// The dense side of the joint problem: factors between poses and structure, in the reduced system as they are.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/solve/bundle/block_matrix.h"
#include "core/solve/bundle_adjustment.h"

namespace vsgraphs {

// Where each variable stands in the reduced system: free poses first, then planes, centroids, markers; -1 if fixed.
struct VariableOrder {
  std::vector<int> pose, plane, centroid, marker;
  std::vector<int> dims;

  explicit VariableOrder(const BundleProblem& problem);
  int of(VariableRef v) const;
};

// Moves every free variable by its part of `step`.
void retract(const VariableOrder& order, const BlockMatrix& pattern, const Eigen::VectorXd& step,
             const std::vector<Se3>& poses, const StructureVariables& structures,
             std::vector<Se3>& moved_poses, StructureVariables& moved_structures);

class DensePart {
 public:
  DensePart(const BundleProblem& problem, const VariableOrder& order);
  // Appends to rows[c] the variables r > c that share a factor with c.
  void add_pairs(std::vector<std::vector<int>>& rows) const;
  double cost(const VariableValues& values);
  // Adds J'J to the blocks of `matrix` and -J'r to `b`.
  void linearise(const VariableValues& values, const BlockMatrix& pattern, double* matrix,
                 Eigen::VectorXd& b);

 private:
  const std::vector<std::unique_ptr<const DenseFactor>>& factors_;
  std::vector<std::vector<int>> variables_;  // per factor, -1 if fixed
  FactorRows rows_;
};

}  // namespace vsgraphs
