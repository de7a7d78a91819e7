// Cost and normal equations of the reprojection factor, written out: the same numbers as factors/reprojection.h (a test
// holds the two together), with everything shared between the blocks computed once.
#include <algorithm>
#include <cmath>

#include "core/solve/bundle/landmark_part.h"
#include "core/solve/factors/reprojection.h"

namespace vsgraphs {
namespace {

// Cost of an observation whose point is behind the camera: constant, so it pulls nowhere, and high, so that a step that
// takes a point behind a camera is not mistaken for an improvement.
constexpr double invalid_chi2 = 1e4;

struct Projected {
  double x, y, iz;       // x/z, y/z, 1/z
  double ru, rv, rd;     // whitened residual
  double chi2;
};

template <typename Observation>
inline bool project(const Intrinsics& k, const Eigen::Vector3d& p, const Observation& o, Projected& out) {
  if (!(p.z() >= min_projection_depth_m)) return false;
  out.iz = 1.0 / p.z();
  out.x = p.x() * out.iz;
  out.y = p.y() * out.iz;
  const double s = o.inv_sigma_px;
  out.ru = (k.fx * out.x + (k.cx - o.u)) * s;
  out.rv = (k.fy * out.y + (k.cy - o.v)) * s;
  out.rd = (out.iz - o.inverse_depth) * o.inv_sigma_inverse_depth;
  out.chi2 = out.ru * out.ru + out.rv * out.rv + out.rd * out.rd;
  return true;
}

}  // namespace

double LandmarkPart::cost(const std::vector<Se3>& poses, const std::vector<Eigen::Vector3d>& landmarks) const {
  double sum = 0;
  for (std::size_t l = 0; l + 1 < landmarks_.size(); ++l) {
    const Eigen::Vector3d& point = landmarks[l];
    double of_landmark = 0;
    for (int i = landmarks_[l].observation_begin; i < landmarks_[l + 1].observation_begin; ++i) {
      const Observation& o = observations_[i];
      if (!(o.inv_sigma_px > 0)) continue;
      const Se3& pose = poses[o.pose];
      const Eigen::Vector3d p = pose.rotation().transpose() * (point - pose.translation());
      Projected q;
      const Huber huber{robust_delta(o)};
      of_landmark += huber.cost(project(k_, p, o, q) ? q.chi2 : invalid_chi2);
    }
    sum += of_landmark;
  }
  return 0.5 * sum;
}

void LandmarkPart::linearise_landmark(std::size_t l, const std::vector<Se3>& poses, const Eigen::Vector3d& point) {
  Landmark& landmark = landmarks_[l];
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (int e = landmark.edge_begin; e < landmarks_[l + 1].edge_begin; ++e) edges_[e].w.fill(0);
  for (int i = landmark.observation_begin; i < landmarks_[l + 1].observation_begin; ++i) {
    const Observation& o = observations_[i];
    const Se3& pose = poses[o.pose];
    const Eigen::Matrix3d& r = pose.rotation();
    const Eigen::Vector3d p = r.transpose() * (point - pose.translation());
    Projected q;
    if (!(o.inv_sigma_px > 0) || !project(k_, p, o, q)) continue;
    const double weight = Huber{robust_delta(o)}.weight(q.chi2);
    // A = d residual / d p_c has rows (a, 0, -a x), (0, c, -c y), (0, 0, -e); M = w A'A, g = w A'r.
    const double a = k_.fx * q.iz * o.inv_sigma_px, c = k_.fy * q.iz * o.inv_sigma_px;
    const double e = q.iz * q.iz * o.inv_sigma_inverse_depth;
    const double waa = weight * a * a, wcc = weight * c * c;
    const double m02 = -waa * q.x, m12 = -wcc * q.y, m22 = weight * e * e - m02 * q.x - m12 * q.y;
    const double wau = weight * a * q.ru, wcv = weight * c * q.rv;
    const Eigen::Vector3d g(wau, wcv, -q.x * wau - q.y * wcv - weight * e * q.rd);
    Eigen::Matrix3d m;
    m << waa, 0, m02, 0, wcc, m12, m02, m12, m22;
    const Eigen::Matrix3d n = m * r.transpose();
    h += r * n;
    b -= r * g;
    if (o.edge < 0) continue;
    Edge& edge = edges_[o.edge];
    // d p_c / d xi = [-I, skew(p)]: the blocks follow as cross products with p.
    for (int k = 0; k < 3; ++k) {
      Eigen::Map<Vector6d> w(edge.w.data() + 6 * k);
      w.head<3>() -= n.col(k);
      w.tail<3>() -= p.cross(n.col(k));
    }
    Pose& sum = pose_sums_[edge.variable];
    Eigen::Matrix3d lower;  // rotation rows, translation columns
    for (int k = 0; k < 3; ++k) lower.col(k) = p.cross(m.col(k));
    double* to = sum.h.data();
    to[0] += m(0, 0), to[1] += m(1, 0), to[2] += m(2, 0);
    to[3] += lower(0, 0), to[4] += lower(1, 0), to[5] += lower(2, 0);
    to[6] += m(1, 1), to[7] += m(2, 1);
    to[8] += lower(0, 1), to[9] += lower(1, 1), to[10] += lower(2, 1);
    to[11] += m(2, 2);
    to[12] += lower(0, 2), to[13] += lower(1, 2), to[14] += lower(2, 2);
    const Eigen::Vector3d row0 = lower.row(0), row1 = lower.row(1), row2 = lower.row(2);
    const Eigen::Vector3d t0 = p.cross(row0), t1 = p.cross(row1), t2 = p.cross(row2);
    to[15] += t0[0], to[16] += t1[0], to[17] += t2[0];
    to[18] += t1[1], to[19] += t2[1];
    to[20] += t2[2];
    const Eigen::Vector3d torque = p.cross(g);
    for (int k = 0; k < 3; ++k) {
      sum.b[k] += g[k];
      sum.b[3 + k] += torque[k];
    }
  }
  landmark.h = {h(0, 0), h(1, 0), h(2, 0), h(1, 1), h(2, 1), h(2, 2)};
  landmark.b = {b[0], b[1], b[2]};
}

void LandmarkPart::linearise(const std::vector<Se3>& poses, const std::vector<Eigen::Vector3d>& landmarks,
                             double* values, Eigen::VectorXd& b) {
  for (Pose& p : pose_sums_) p = {};
  for (std::size_t l = 0; l + 1 < landmarks_.size(); ++l) linearise_landmark(l, poses, landmarks[l]);
  for (int v = 0; v < free_poses_; ++v) {
    double* block = values + diagonal_value_[v];
    int at = 0;
    for (int c = 0; c < 6; ++c) {
      for (int r = c; r < 6; ++r) block[6 * c + r] += pose_sums_[v].h[at++];
      b[6 * v + c] += pose_sums_[v].b[c];
    }
  }
}

}  // namespace vsgraphs
