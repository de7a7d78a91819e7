// Schur complement of the landmarks and the way back.
#include <algorithm>
#include <cmath>

#include "core/solve/bundle/landmark_part.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // see lanes.h
#endif

namespace vsgraphs {
namespace {

// Bounds of the damping's diagonal (per variable of a landmark, 1/m^2).
constexpr double min_diagonal = 1e-3;
// Share of the trace added to every landmark: keeps a landmark seen along one ray only (rank 2) invertible. It changes
// steps along directions that carry no gradient, not the optimum.
constexpr double floor_share = 1e-9;

std::array<double, 3> damping(const double* h, double lambda) {
  const double floor = floor_share * (h[0] + h[3] + h[5]);
  return {lambda * std::max(h[0], min_diagonal) + floor, lambda * std::max(h[3], min_diagonal) + floor,
          lambda * std::max(h[5], min_diagonal) + floor};
}

// Inverse of a symmetric 3x3 through LDL'; zero, which keeps the landmark where it is, unless positive definite.
std::array<double, 6> inverse_or_zero(const double* h, const std::array<double, 3>& damp) {
  const double d0 = h[0] + damp[0];
  if (!(d0 > 0)) return {};
  const double i0 = 1 / d0, l10 = h[1] * i0, l20 = h[2] * i0;
  const double d1 = h[3] + damp[1] - l10 * h[1];
  if (!(d1 > 0)) return {};
  const double i1 = 1 / d1, t = h[4] - l20 * h[1], l21 = t * i1;
  const double d2 = h[5] + damp[2] - l20 * h[2] - l21 * t;
  if (!(d2 > 0)) return {};
  const double i2 = 1 / d2, m20 = l10 * l21 - l20;
  return {i0 + l10 * l10 * i1 + m20 * m20 * i2,
          -l10 * i1 - m20 * l21 * i2,
          m20 * i2,
          i1 + l21 * l21 * i2,
          -l21 * i2,
          i2};
}

}  // namespace

// Fills tall_ with Y = W C of the landmark's edges and moves their share of the right side. W and Y both carry a minus sign
// that cancels in Y W'.
void LandmarkPart::prepare_edges(std::size_t l, const std::array<double, 6>& c, Eigen::VectorXd& b) {
  Eigen::Matrix3d inverse;
  inverse << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  const Eigen::Vector3d shift = inverse * landmarks_[l].b();
  for (int e = edge_begin_[l]; e < edge_begin_[l + 1]; ++e) {
    const auto n = edges_[e].n();
    const auto p = edges_[e].p();
    const Eigen::Vector3d force = n * shift, torque = p.cross(force);
    double* to = b.data() + 6 * edge_variable_[e];
    for (int k = 0; k < 3; ++k) to[k] += force[k], to[3 + k] += torque[k];
    const Eigen::Matrix3d y = n.lazyProduct(inverse);
    Tall& tall = tall_[e - edge_begin_[l]];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d yk = y.col(k), t = p.cross(yk);
      tall.top[k] = Lanes{yk[0], yk[1], yk[2], t[0]};
      tall.middle[k] = Lanes{t[1], t[2], yk[0], yk[1]};
      tall.bottom[k] = Lanes{yk[2], t[0], t[1], t[2]};
    }
  }
}

// Subtracts Y_j W_i' from the block of (j, i) for one edge i and all edges j from i on; returns one past their pairs.
const int* LandmarkPart::subtract_column(const Edge& edge, int i, int edges, const int* pair,
                                         double* values) const {
  Eigen::Matrix<double, 6, 3> w;
  for (int k = 0; k < 3; ++k) {
    w.col(k).head<3>() = edge.n().col(k);
    w.col(k).tail<3>() = edge.p().cross(edge.n().col(k));
  }
  Lanes even[3][3], mixed[3][3], odd[3][3];  // factors of columns 2h, both, and 2h + 1, per column k of Y
  for (int h = 0; h < 3; ++h) {
    for (int k = 0; k < 3; ++k) {
      const double x = w(2 * h, k), y = w(2 * h + 1, k);
      even[h][k] = lanes(x);
      mixed[h][k] = Lanes{x, x, y, y};
      odd[h][k] = lanes(y);
    }
  }
  for (int j = i; j < edges; ++j) {
    double* block = values + *pair++;
    const Tall& y = tall_[j];
    for (int h = 0; h < 3; ++h, block += 12) {
      store(block, load(block) - (y.top[0] * even[h][0] + y.top[1] * even[h][1] + y.top[2] * even[h][2]));
      store(block + 4, load(block + 4) - (y.middle[0] * mixed[h][0] + y.middle[1] * mixed[h][1] +
                                          y.middle[2] * mixed[h][2]));
      store(block + 8,
            load(block + 8) - (y.bottom[0] * odd[h][0] + y.bottom[1] * odd[h][1] + y.bottom[2] * odd[h][2]));
    }
  }
  return pair;
}

void LandmarkPart::eliminate(double lambda, double* values, Eigen::VectorXd& b) {
  for (std::size_t l = 0; l < landmarks_.size(); ++l) {
    inverses_[l] = inverse_or_zero(landmarks_[l].h(), damping(landmarks_[l].h(), lambda));
    prepare_edges(l, inverses_[l], b);
    const int edges = edge_begin_[l + 1] - edge_begin_[l];
    const int* pair = pair_value_.data() + pair_begin_[l];
    for (int i = 0; i < edges; ++i)
      pair = subtract_column(edges_[edge_begin_[l] + i], i, edges, pair, values);
  }
}

double LandmarkPart::back_substitute(double lambda, const Eigen::VectorXd& step,
                                     const std::vector<Eigen::Vector3d>& landmarks,
                                     std::vector<Eigen::Vector3d>& moved) const {
  double decrease = 0;
  for (std::size_t l = 0; l < landmarks_.size(); ++l) {
    const Landmark& landmark = landmarks_[l];
    const Eigen::Vector3d b_landmark = landmark.b();
    Eigen::Vector3d right = b_landmark;
    for (int e = edge_begin_[l]; e < edge_begin_[l + 1]; ++e) {
      // W' step = -N' (rho + phi x p)
      const auto n = edges_[e].n();
      const auto p = edges_[e].p();
      const double* xi = step.data() + 6 * edge_variable_[e];
      const Eigen::Vector3d rho(xi[0], xi[1], xi[2]), phi(xi[3], xi[4], xi[5]);
      const Eigen::Vector3d motion = rho + phi.cross(p);
      right += n.transpose().lazyProduct(motion);
    }
    const auto& c = inverses_[l];
    const Eigen::Vector3d delta(c[0] * right[0] + c[1] * right[1] + c[2] * right[2],
                                c[1] * right[0] + c[3] * right[1] + c[4] * right[2],
                                c[2] * right[0] + c[4] * right[1] + c[5] * right[2]);
    const auto d = damping(landmark.h(), lambda);
    decrease += delta.dot(b_landmark) +
                (d[0] * delta[0] * delta[0] + d[1] * delta[1] * delta[1] + d[2] * delta[2] * delta[2]);
    moved[l] = landmarks[l] + delta;
  }
  return 0.5 * decrease;
}

}  // namespace vsgraphs
