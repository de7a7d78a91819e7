#include "core/solve/pose_graph.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>

#include "core/base/check.h"
#include "core/solve/factors/relative_pose.h"

namespace vsgraphs {

Matrix6d square_root_of_information(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
  const Vector6d& values = eigen.eigenvalues();
  require_input(eigen.info() == Eigen::Success && values[0] >= -1e-9 * std::abs(values[5]),
                "pose graph: an edge's information is not finite or has a negative eigenvalue");
  return values.cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

SolveReport optimise_pose_graph(PoseGraph& graph, int max_iterations, const std::function<bool()>& stop) {
  BundleProblem problem;
  problem.poses = graph.poses;
  problem.pose_fixed = graph.pose_fixed;
  for (const PoseGraphEdge& edge : graph.edges) {
    problem.factors.push_back(std::make_unique<RelativePose>(
        VariableRef{VariableKind::pose, edge.a}, VariableRef{VariableKind::pose, edge.b}, edge.a_from_b,
        square_root_of_information(edge.information), Huber{edge.huber_sigmas}));
  }
  BundleOptions options;
  options.max_iterations = max_iterations;
  SolveReport report = solve_bundle(problem, options, stop);
  graph.poses = std::move(problem.poses);
  return report;
}

}  // namespace vsgraphs
