#include "core/solve/marginals.h"

#include <Eigen/Cholesky>

#include "core/base/check.h"
#include "core/geometry/se3_jacobian.h"
#include "core/solve/bundle/pattern.h"
#include "core/solve/bundle/validate.h"

namespace vsgraphs {

namespace {

// The information of all free variables but the landmarks, lower half; how `order` places them.
Eigen::MatrixXd reduced_information(const BundleProblem& problem, const std::vector<ObservationFit>& fit,
                                    const BundleOptions& options, const VariableOrder& order) {
  LandmarkPart landmarks(problem, order.pose, options);
  DensePart dense(problem, order);
  BlockMatrix pattern;
  build_pattern(order, dense, landmarks, pattern);
  if (!fit.empty()) landmarks.drop(fit);
  std::vector<double> values(pattern.value_count(), 0.0);
  Eigen::VectorXd unused = Eigen::VectorXd::Zero(pattern.scalars());
  landmarks.linearise(problem.poses, problem.landmarks, values.data(), unused);
  dense.linearise({problem.poses, problem.structures}, pattern, values.data(), unused);
  landmarks.eliminate(0, values.data(), unused);
  Eigen::MatrixXd information;
  pattern.to_dense(values.data(), information);
  return information;
}

}  // namespace

std::optional<Matrix6d> relative_covariance(const BundleProblem& problem, int a, int b,
                                            const std::vector<ObservationFit>& fit,
                                            const BundleOptions& options) {
  validate(problem, options);
  VSG_INVARIANT(fit.empty() || fit.size() == problem.observations.size());
  const auto at_a = static_cast<std::size_t>(a), at_b = static_cast<std::size_t>(b);
  VSG_INVARIANT(a != b && at_a < problem.poses.size() && at_b < problem.poses.size());
  const VariableOrder order(problem);
  VSG_INVARIANT(order.pose[at_a] >= 0 || order.pose[at_b] >= 0);
  const Eigen::MatrixXd information = reduced_information(problem, fit, options, order);
  const Eigen::LLT<Eigen::MatrixXd> factor(information);  // reads the lower half
  if (factor.info() != Eigen::Success) return std::nullopt;
  // a_from_b moves by exp(-Ad(b_from_a) xi_a) exp(xi_b). Free poses come first, six scalars each.
  Eigen::MatrixXd by_variables = Eigen::MatrixXd::Zero(information.rows(), 6);
  if (order.pose[at_a] >= 0) {
    const Matrix6d carry = se3_adjoint(problem.poses[at_b].inverse() * problem.poses[at_a]);
    by_variables.middleRows<6>(6 * order.pose[at_a]) = -carry.transpose();
  }
  if (order.pose[at_b] >= 0) by_variables.middleRows<6>(6 * order.pose[at_b]) = Matrix6d::Identity();
  const Eigen::MatrixXd half = factor.matrixL().solve(by_variables);
  const Matrix6d covariance = half.transpose() * half;
  if (!covariance.allFinite()) return std::nullopt;
  return covariance;
}

}  // namespace vsgraphs
