// Cost and normal equations of the reprojection factor for four observations of one pose at a time: the same numbers as
// factors/reprojection.h (a test holds the two together), with everything the blocks share computed once.
#include "core/solve/bundle/landmark_part.h"
#include "core/solve/factors/reprojection.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // see lanes.h
#endif

namespace vsgraphs {
namespace {

// Cost of an observation whose point is behind the camera: constant, so it pulls nowhere, and high, so that a step that
// takes a point behind a camera is not mistaken for an improvement.
constexpr double invalid_chi2 = 1e4;

}  // namespace

struct LandmarkPart::Projection {
  Lanes px, py, pz;      // point in the camera
  Lanes x, y, iz;        // x/z, y/z, 1/z
  Lanes ru, rv, rd;      // whitened residual
  Lanes cost;            // rho
  Lanes weight;          // rho'; 0 for padding and points behind
};

struct LandmarkPart::PoseSums {
  Lanes m[5] = {};      // 00 20 11 21 22 of the upper left block; 10 is zero
  Lanes lower[9] = {};  // rotation rows, translation columns, column-major
  Lanes turn[6] = {};   // 00 10 20 11 21 22 of the lower right block
  Lanes b[6] = {};
};

inline void LandmarkPart::project(const Group& g, const Se3& pose, const std::vector<Eigen::Vector3d>& landmarks,
                                  Projection& out) const {
  Lanes dx, dy, dz;
  for (int k = 0; k < lane_count; ++k) {
    const Eigen::Vector3d& point = landmarks[g.landmark[k]];
    dx[k] = point.x();
    dy[k] = point.y();
    dz[k] = point.z();
  }
  const Eigen::Matrix3d& r = pose.rotation();
  const Eigen::Vector3d& t = pose.translation();
  dx -= lanes(t[0]), dy -= lanes(t[1]), dz -= lanes(t[2]);
  out.px = lanes(r(0, 0)) * dx + lanes(r(1, 0)) * dy + lanes(r(2, 0)) * dz;
  out.py = lanes(r(0, 1)) * dx + lanes(r(1, 1)) * dy + lanes(r(2, 1)) * dz;
  out.pz = lanes(r(0, 2)) * dx + lanes(r(1, 2)) * dy + lanes(r(2, 2)) * dz;
  const Lanes zero = lanes(0), one = lanes(1);
  const auto valid = out.pz >= lanes(min_projection_depth_m);
  const auto used = g.weight_px > zero;
  out.iz = one / (valid ? out.pz : one);
  out.x = out.px * out.iz;
  out.y = out.py * out.iz;
  out.ru = (lanes(k_.fx) * out.x + lanes(k_.cx) - g.u) * g.weight_px;
  out.rv = (lanes(k_.fy) * out.y + lanes(k_.cy) - g.v) * g.weight_px;
  out.rd = (out.iz - g.inverse_depth) * g.weight_depth;
  const Lanes chi2 = valid ? out.ru * out.ru + out.rv * out.rv + out.rd * out.rd : lanes(invalid_chi2);
  // Huber; a threshold of zero or less means none.
  const Lanes d2 = g.delta * g.delta;
  const auto far = (chi2 > d2) & (g.delta > zero);
  const Lanes norm = sqrt(chi2);
  const Lanes rho = far ? lanes(2) * g.delta * norm - d2 : chi2;
  const Lanes slope = far ? g.delta / norm : one;
  out.cost = used ? rho : zero;
  out.weight = valid & used ? slope : zero;
}

double LandmarkPart::cost(const std::vector<Se3>& poses, const std::vector<Eigen::Vector3d>& landmarks) const {
  double total = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Lanes of_pose = {};
    for (int g = group_begin_[i]; g < group_begin_[i + 1]; ++g) {
      Projection q;
      project(groups_[g], poses[i], landmarks, q);
      of_pose += q.cost;
    }
    total += sum(of_pose);
  }
  return 0.5 * total;
}

// A = d residual / d p_c has rows (a, 0, -a x), (0, c, -c y), (0, 0, -e); M = w A'A, g = w A'r; and with
// d p_c / d xi = [-I, skew(p)], d p_c / d point = R' every block is a product of M and R or a cross product with p.
void LandmarkPart::linearise_group(const Group& group, const Se3& pose, const std::vector<Eigen::Vector3d>& landmarks,
                                   PoseSums& s) {
  Projection q;
  project(group, pose, landmarks, q);
  const Lanes a = lanes(k_.fx) * q.iz * group.weight_px, c = lanes(k_.fy) * q.iz * group.weight_px;
  const Lanes e = q.iz * q.iz * group.weight_depth;
  const Lanes m00 = q.weight * a * a, m11 = q.weight * c * c, we = q.weight * e;
  const Lanes m02 = -m00 * q.x, m12 = -m11 * q.y, m22 = we * e - m02 * q.x - m12 * q.y;
  const Lanes g0 = q.weight * a * q.ru, g1 = q.weight * c * q.rv, g2 = -(q.x * g0) - q.y * g1 - we * q.rd;

  s.m[0] += m00, s.m[1] += m02, s.m[2] += m11, s.m[3] += m12, s.m[4] += m22;
  const Lanes l00 = q.py * m02, l10 = q.pz * m00 - q.px * m02, l20 = -(q.py * m00);
  const Lanes l01 = q.py * m12 - q.pz * m11, l11 = -(q.px * m12), l21 = q.px * m11;
  const Lanes l02 = q.py * m22 - q.pz * m12, l12 = q.pz * m02 - q.px * m22, l22 = q.px * m12 - q.py * m02;
  s.lower[0] += l00, s.lower[1] += l10, s.lower[2] += l20;
  s.lower[3] += l01, s.lower[4] += l11, s.lower[5] += l21;
  s.lower[6] += l02, s.lower[7] += l12, s.lower[8] += l22;
  s.turn[0] += q.py * l02 - q.pz * l01;
  s.turn[1] += q.py * l12 - q.pz * l11;
  s.turn[2] += q.py * l22 - q.pz * l21;
  s.turn[3] += q.pz * l10 - q.px * l12;
  s.turn[4] += q.pz * l20 - q.px * l22;
  s.turn[5] += q.px * l21 - q.py * l20;
  s.b[0] += g0, s.b[1] += g1, s.b[2] += g2;
  s.b[3] += q.py * g2 - q.pz * g1;
  s.b[4] += q.pz * g0 - q.px * g2;
  s.b[5] += q.px * g1 - q.py * g0;

  Lanes r[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) r[i][k] = lanes(pose.rotation()(i, k));
  Lanes of_edge[12];  // N by columns, p
  for (int k = 0; k < 3; ++k) {
    of_edge[3 * k + 0] = m00 * r[k][0] + m02 * r[k][2];
    of_edge[3 * k + 1] = m11 * r[k][1] + m12 * r[k][2];
    of_edge[3 * k + 2] = m02 * r[k][0] + m12 * r[k][1] + m22 * r[k][2];
  }
  of_edge[9] = q.px, of_edge[10] = q.py, of_edge[11] = q.pz;
  Lanes of_landmark[12] = {};  // R N lower half, -R g
  int at = 0;
  for (int k = 0; k < 3; ++k) {
    for (int i = k; i < 3; ++i) {
      of_landmark[at++] = r[i][0] * of_edge[3 * k] + r[i][1] * of_edge[3 * k + 1] + r[i][2] * of_edge[3 * k + 2];
    }
  }
  for (int i = 0; i < 3; ++i) of_landmark[6 + i] = -(r[i][0] * g0 + r[i][1] * g1 + r[i][2] * g2);
  for (int part = 0; part < 12; part += 4) {
    transpose(of_edge + part);
    transpose(of_landmark + part);
  }
  for (int k = 0; k < lane_count; ++k) {
    if (group.source[k] < 0) break;
    double* landmark = landmarks_[group.landmark[k]].h.data();
    for (int part = 0; part < 12; part += 4) store(landmark + part, load(landmark + part) + of_landmark[part + k]);
    if (group.edge[k] < 0) continue;
    Edge& edge = edges_[group.edge[k]];
    store(edge.n.data(), load(edge.n.data()) + of_edge[k]);
    store(edge.n.data() + 4, load(edge.n.data() + 4) + of_edge[4 + k]);
    const Lanes last = of_edge[8 + k];  // one more of N, and p, which all observations of an edge share
    edge.n[8] += last[0];
    edge.p = {last[1], last[2], last[3]};
  }
}

void LandmarkPart::linearise(const std::vector<Se3>& poses, const std::vector<Eigen::Vector3d>& landmarks,
                             double* values, Eigen::VectorXd& b) {
  std::fill(landmarks_.begin(), landmarks_.end(), Landmark{});
  std::fill(edges_.begin(), edges_.end(), Edge{});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    PoseSums s;
    for (int g = group_begin_[i]; g < group_begin_[i + 1]; ++g) linearise_group(groups_[g], poses[i], landmarks, s);
    const int variable = variable_of_pose_[i];
    if (variable < 0) continue;
    Eigen::Map<Matrix6d> block(values + diagonal_value_[variable]);
    block(0, 0) += sum(s.m[0]), block(2, 0) += sum(s.m[1]);
    block(1, 1) += sum(s.m[2]), block(2, 1) += sum(s.m[3]), block(2, 2) += sum(s.m[4]);
    for (int k = 0; k < 9; ++k) block(3 + k % 3, k / 3) += sum(s.lower[k]);
    block(3, 3) += sum(s.turn[0]), block(4, 3) += sum(s.turn[1]), block(5, 3) += sum(s.turn[2]);
    block(4, 4) += sum(s.turn[3]), block(5, 4) += sum(s.turn[4]), block(5, 5) += sum(s.turn[5]);
    for (int k = 0; k < 6; ++k) b[6 * variable + k] += sum(s.b[k]);
  }
}

}  // namespace vsgraphs
