#include "core/geometry/align.h"

#include <Eigen/SVD>
#include <cmath>

#include "core/base/check.h"

namespace vsgraphs {

std::optional<Se3> align_points(std::span<const Eigen::Vector3d> in_a, std::span<const Eigen::Vector3d> in_b,
                                std::span<const double> weights) {
  require_input(in_a.size() == in_b.size(), "align_points: the two point sets must have the same length");
  require_input(weights.empty() || weights.size() == in_a.size(),
                "align_points: give one weight per pair, or none");
  const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  double total = 0;
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    mean_a += weight(i) * in_a[i];
    mean_b += weight(i) * in_b[i];
    total += weight(i);
  }
  if (in_a.size() < 3 || !(total > 0)) return {};
  mean_a /= total;
  mean_b /= total;
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    correlation += weight(i) / total * (in_a[i] - mean_a) * (in_b[i] - mean_b).transpose();
  }
  if (!correlation.allFinite()) return {};
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Two directions of spread fix a rotation; one leaves the turn about it open.
  const Eigen::Vector3d s = svd.singularValues();
  if (!(s[1] > 1e-12 * s[0])) return {};
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
  const Eigen::Matrix3d rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  return Se3(rotation, mean_a - rotation * mean_b);
}

}  // namespace vsgraphs
