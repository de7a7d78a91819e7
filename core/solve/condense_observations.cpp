#include "core/solve/condense_observations.h"

#include <Eigen/Eigenvalues>
#include <vector>

#include "core/solve/factors/plane_difference.h"

namespace vsgraphs {
namespace {

struct Quadratic {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

// The sum around `plane`, in its tangent coordinates.
Quadratic sum_at(const AnchoredPlane& plane, std::span<const WeightedPlane> observations,
                 const std::vector<PlaneDifference>& differences, const Huber& robust) {
  Quadratic sum;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    Eigen::Matrix3d jacobian;
    const Eigen::Vector3d residual = differences[i].residual(plane, &jacobian);
    const double weight = observations[i].weight * robust.weight(residual.squaredNorm());
    sum.information += weight * jacobian.transpose() * jacobian;
    sum.gradient += weight * jacobian.transpose() * residual;
  }
  return sum;
}

// The Newton step in the directions that are known.
Eigen::Vector3d step(const Quadratic& sum) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(sum.information);
  const double unknown = 1e-12 * axes.eigenvalues()[2];
  Eigen::Vector3d along = axes.eigenvectors().transpose() * sum.gradient;
  for (int i = 0; i < 3; ++i)
    along[i] = axes.eigenvalues()[i] > unknown ? -along[i] / axes.eigenvalues()[i] : 0;
  return axes.eigenvectors() * along;
}

}  // namespace

std::optional<PlaneEstimate> condense_observations(std::span<const WeightedPlane> observations,
                                                   const AnchoredPlane& start, Huber robust) {
  constexpr int max_iterations = 30;  // reweighting converges linearly; good observations take three
  constexpr double settled = 1e-9;    // rad, m
  std::vector<PlaneDifference> differences;
  differences.reserve(observations.size());
  for (const WeightedPlane& o : observations) differences.emplace_back(o.seen);
  AnchoredPlane plane = start;
  Quadratic sum = sum_at(plane, observations, differences, robust);
  if (!(sum.information.trace() > 0)) return std::nullopt;
  for (int i = 0; i < max_iterations; ++i) {
    const Eigen::Vector3d move = step(sum);
    plane = plane.retract(move);
    sum = sum_at(plane, observations, differences, robust);
    if (move.norm() < settled) break;
  }
  return PlaneEstimate{plane, sum.information};
}

}  // namespace vsgraphs
