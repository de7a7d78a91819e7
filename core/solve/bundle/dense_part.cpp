#include "core/solve/bundle/dense_part.h"

namespace vsgraphs {
namespace {

std::vector<int> place(std::size_t count, const std::vector<std::uint8_t>& fixed, int dof,
                       std::vector<int>& dims) {
  std::vector<int> at(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    if (!fixed.empty() && fixed[i]) continue;
    at[i] = static_cast<int>(dims.size());
    dims.push_back(dof);
  }
  return at;
}

}  // namespace

VariableOrder::VariableOrder(const BundleProblem& problem) {
  const StructureVariables& s = problem.structures;
  pose = place(problem.poses.size(), problem.pose_fixed, dof_of(VariableKind::pose), dims);
  plane = place(s.planes.size(), s.plane_fixed, dof_of(VariableKind::plane), dims);
  centroid = place(s.centroids.size(), s.centroid_fixed, dof_of(VariableKind::centroid), dims);
  marker = place(s.markers.size(), s.marker_fixed, dof_of(VariableKind::marker), dims);
}

int VariableOrder::of(VariableRef v) const {
  switch (v.kind) {
    case VariableKind::pose:
      return pose[v.index];
    case VariableKind::plane:
      return plane[v.index];
    case VariableKind::centroid:
      return centroid[v.index];
    case VariableKind::marker:
      return marker[v.index];
  }
  return -1;
}

void retract(const VariableOrder& order, const BlockMatrix& pattern, const Eigen::VectorXd& step,
             const std::vector<Se3>& poses, const StructureVariables& structures,
             std::vector<Se3>& moved_poses, StructureVariables& moved_structures) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (order.pose[i] >= 0) moved_poses[i] = poses[i].retract(step.segment<6>(pattern.offset(order.pose[i])));
  }
  const auto part3 = [&](int v) -> Eigen::Vector3d { return step.segment<3>(pattern.offset(v)); };
  for (std::size_t i = 0; i < structures.planes.size(); ++i) {
    if (order.plane[i] >= 0) moved_structures.planes[i] = structures.planes[i].retract(part3(order.plane[i]));
  }
  for (std::size_t i = 0; i < structures.centroids.size(); ++i) {
    if (order.centroid[i] >= 0)
      moved_structures.centroids[i] = structures.centroids[i] + part3(order.centroid[i]);
  }
  for (std::size_t i = 0; i < structures.markers.size(); ++i) {
    if (order.marker[i] < 0) continue;
    moved_structures.markers[i] =
        structures.markers[i].retract(step.segment<6>(pattern.offset(order.marker[i])));
  }
}

DensePart::DensePart(const BundleProblem& problem, const VariableOrder& order) : factors_(problem.factors) {
  variables_.reserve(factors_.size());
  for (const auto& factor : factors_) {
    auto& places = variables_.emplace_back();
    for (const VariableRef& v : factor->variables()) places.push_back(order.of(v));
  }
}

void DensePart::add_pairs(std::vector<std::vector<int>>& rows) const {
  for (const auto& places : variables_) {
    for (int c : places) {
      for (int r : places) {
        if (c >= 0 && r > c) rows[c].push_back(r);
      }
    }
  }
}

double DensePart::cost(const VariableValues& values) {
  double sum = 0;
  for (const auto& factor : factors_) {
    factor->resize(rows_);
    if (factor->evaluate(values, false, rows_)) sum += factor->robust().cost(rows_.residual.squaredNorm());
  }
  return 0.5 * sum;
}

void DensePart::linearise(const VariableValues& values, const BlockMatrix& pattern, double* matrix,
                          Eigen::VectorXd& b) {
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    const DenseFactor& factor = *factors_[f];
    factor.resize(rows_);
    if (!factor.evaluate(values, true, rows_)) continue;
    const double weight = factor.robust().weight(rows_.residual.squaredNorm());
    const auto& places = variables_[f];
    for (std::size_t i = 0; i < places.size(); ++i) {
      const int c = places[i];
      if (c < 0) continue;
      b.segment(pattern.offset(c), pattern.dim(c)) -=
          weight * rows_.jacobians[i].transpose() * rows_.residual;
      for (std::size_t j = 0; j < places.size(); ++j) {
        const int r = places[j];
        if (r < c) continue;  // fixed, or the other half
        Eigen::Map<Eigen::MatrixXd> block(matrix + pattern.value_begin(pattern.find(r, c)), pattern.dim(r),
                                          pattern.dim(c));
        block += weight * rows_.jacobians[j].transpose() * rows_.jacobians[i];
      }
    }
  }
}

}  // namespace vsgraphs
