// Schur complement of the landmarks and the way back.
#include <algorithm>
#include <cmath>

#include "core/solve/bundle/landmark_part.h"

namespace vsgraphs {
namespace {

// Bounds of the damping's diagonal (per variable of a landmark, 1/m^2).
constexpr double min_diagonal = 1e-3;
// Share of the trace added to every landmark: keeps a landmark seen along one ray only (rank 2) invertible. It changes
// steps along directions that carry no gradient, not the optimum.
constexpr double floor_share = 1e-9;

std::array<double, 3> damping(const std::array<double, 6>& h, double lambda) {
  const double floor = floor_share * (h[0] + h[3] + h[5]);
  return {lambda * std::max(h[0], min_diagonal) + floor, lambda * std::max(h[3], min_diagonal) + floor,
          lambda * std::max(h[5], min_diagonal) + floor};
}

// Inverse of a symmetric 3x3 through LDL'; zero, which keeps the landmark where it is, unless positive definite.
std::array<double, 6> inverse_or_zero(const std::array<double, 6>& h, const std::array<double, 3>& damp) {
  const double d0 = h[0] + damp[0];
  if (!(d0 > 0)) return {};
  const double i0 = 1 / d0, l10 = h[1] * i0, l20 = h[2] * i0;
  const double d1 = h[3] + damp[1] - l10 * h[1];
  if (!(d1 > 0)) return {};
  const double i1 = 1 / d1, t = h[4] - l20 * h[1], l21 = t * i1;
  const double d2 = h[5] + damp[2] - l20 * h[2] - l21 * t;
  if (!(d2 > 0)) return {};
  const double i2 = 1 / d2, m20 = l10 * l21 - l20;
  return {i0 + l10 * l10 * i1 + m20 * m20 * i2, -l10 * i1 - m20 * l21 * i2, m20 * i2, i1 + l21 * l21 * i2,
          -l21 * i2, i2};
}

}  // namespace

void LandmarkPart::eliminate(double lambda, double* values, Eigen::VectorXd& b) {
  using Matrix63 = Eigen::Matrix<double, 6, 3>;
  const int* pair = pair_value_.data();
  std::vector<Matrix63> y(static_cast<std::size_t>(longest_));
  for (std::size_t l = 0; l + 1 < landmarks_.size(); ++l) {
    Landmark& landmark = landmarks_[l];
    landmark.inverse = inverse_or_zero(landmark.h, damping(landmark.h, lambda));
    const auto& c = landmark.inverse;
    Eigen::Matrix3d inverse;
    inverse << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
    const Eigen::Map<const Eigen::Vector3d> b_landmark(landmark.b.data());
    const int edges = landmarks_[l + 1].edge_begin - landmark.edge_begin;
    const Edge* edge = edges_.data() + landmark.edge_begin;
    for (int i = 0; i < edges; ++i) {
      y[i].noalias() = Eigen::Map<const Matrix63>(edge[i].w.data()) * inverse;
      b.segment<6>(6 * edge[i].variable) -= y[i] * b_landmark;
    }
    for (int i = 0; i < edges; ++i) {
      const Eigen::Map<const Matrix63> w(edge[i].w.data());
      for (int j = i; j < edges; ++j) {
        Eigen::Map<Matrix6d> block(values + *pair++);
        block.noalias() -= y[j].lazyProduct(w.transpose());
      }
    }
  }
}

double LandmarkPart::back_substitute(double lambda, const Eigen::VectorXd& step,
                                     const std::vector<Eigen::Vector3d>& landmarks,
                                     std::vector<Eigen::Vector3d>& moved) const {
  double decrease = 0;
  for (std::size_t l = 0; l + 1 < landmarks_.size(); ++l) {
    const Landmark& landmark = landmarks_[l];
    const Eigen::Map<const Eigen::Vector3d> b_landmark(landmark.b.data());
    Eigen::Vector3d right = b_landmark;
    for (int e = landmark.edge_begin; e < landmarks_[l + 1].edge_begin; ++e) {
      const Eigen::Map<const Eigen::Matrix<double, 6, 3>> w(edges_[e].w.data());
      right.noalias() -= w.transpose() * step.segment<6>(6 * edges_[e].variable);
    }
    const auto& c = landmark.inverse;
    const Eigen::Vector3d delta(c[0] * right[0] + c[1] * right[1] + c[2] * right[2],
                                c[1] * right[0] + c[3] * right[1] + c[4] * right[2],
                                c[2] * right[0] + c[4] * right[1] + c[5] * right[2]);
    const auto d = damping(landmark.h, lambda);
    decrease += delta.dot(b_landmark) +
                (d[0] * delta[0] * delta[0] + d[1] * delta[1] * delta[1] + d[2] * delta[2] * delta[2]);
    moved[l] = landmarks[l] + delta;
  }
  return 0.5 * decrease;
}

}  // namespace vsgraphs
