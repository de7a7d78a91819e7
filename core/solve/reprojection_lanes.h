// The reprojection factor for four observations of one pose at a time: the same numbers as factors/reprojection.h (tests
// hold the two together), with everything the blocks of the normal equations share computed once. Both the pose solver
// and the joint adjustment stand on it.
#pragma once

#include "core/geometry/se3.h"
#include "core/solve/factors/reprojection.h"
#include "core/solve/intrinsics.h"
#include "core/solve/lanes.h"

#pragma GCC diagnostic push
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // see lanes.h
#endif

namespace vsgraphs {

// Cost of an observation whose point is behind the camera: constant, so it pulls nowhere, and high, so that a step that
// takes a point behind a camera is not mistaken for an improvement.
inline constexpr double invalid_chi2 = 1e4;

// Weights are 1/sigma; weight_px 0: padding, or switched off. delta: Huber's threshold, 0 or less for none.
struct ObservationLanes {
  Lanes u, v, inverse_depth, weight_px, weight_depth, delta;
};

struct ProjectionLanes {
  Lanes px, py, pz;  // point in the camera
  Lanes x, y, iz;    // x/z, y/z, 1/z
  Lanes ru, rv, rd;  // whitened residual
  Lanes cost;        // rho
  Lanes weight;      // rho'; 0 for padding and points behind
};

// `wx, wy, wz`: the points in the world.
inline ProjectionLanes project(const Intrinsics& k, const Se3& world_from_camera, Lanes wx, Lanes wy,
                               Lanes wz, const ObservationLanes& o) {
  const Eigen::Matrix3d& r = world_from_camera.rotation();
  const Eigen::Vector3d& t = world_from_camera.translation();
  const Lanes dx = wx - lanes(t[0]), dy = wy - lanes(t[1]), dz = wz - lanes(t[2]);
  const Lanes zero = lanes(0), one = lanes(1);
  ProjectionLanes q;
  q.px = lanes(r(0, 0)) * dx + lanes(r(1, 0)) * dy + lanes(r(2, 0)) * dz;
  q.py = lanes(r(0, 1)) * dx + lanes(r(1, 1)) * dy + lanes(r(2, 1)) * dz;
  q.pz = lanes(r(0, 2)) * dx + lanes(r(1, 2)) * dy + lanes(r(2, 2)) * dz;
  const auto valid = q.pz >= lanes(min_projection_depth_m);
  const auto used = o.weight_px > zero;
  q.iz = one / (valid ? q.pz : one);
  q.x = q.px * q.iz;
  q.y = q.py * q.iz;
  q.ru = (lanes(k.fx) * q.x + lanes(k.cx) - o.u) * o.weight_px;
  q.rv = (lanes(k.fy) * q.y + lanes(k.cy) - o.v) * o.weight_px;
  q.rd = (q.iz - o.inverse_depth) * o.weight_depth;
  const Lanes chi2 = valid ? q.ru * q.ru + q.rv * q.rv + q.rd * q.rd : lanes(invalid_chi2);
  const Lanes d2 = o.delta * o.delta;
  const auto far = (chi2 > d2) & (o.delta > zero);
  const Lanes norm = sqrt(chi2);
  const Lanes rho = far ? lanes(2) * o.delta * norm - d2 : chi2;
  const Lanes slope = far ? o.delta / norm : one;
  q.cost = used ? rho : zero;
  q.weight = valid & used ? slope : zero;
  return q;
}

// What an observation says of its point in the camera: with A = d residual / d p_c of rows (a, 0, -a x), (0, c, -c y),
// (0, 0, -e), the information M = w A'A (m01 is zero) and the gradient g = w A'r.
struct PointInformation {
  Lanes m00, m02, m11, m12, m22, g0, g1, g2;

  PointInformation(const Intrinsics& k, const ObservationLanes& o, const ProjectionLanes& q) {
    const Lanes a = lanes(k.fx) * q.iz * o.weight_px, c = lanes(k.fy) * q.iz * o.weight_px;
    const Lanes e = q.iz * q.iz * o.weight_depth, we = q.weight * e;
    m00 = q.weight * a * a;
    m11 = q.weight * c * c;
    m02 = -m00 * q.x;
    m12 = -m11 * q.y;
    m22 = we * e - m02 * q.x - m12 * q.y;
    g0 = q.weight * a * q.ru;
    g1 = q.weight * c * q.rv;
    g2 = -(q.x * g0) - q.y * g1 - we * q.rd;
  }
};

// Normal equations of one pose. With d p_c / d xi = [-I, skew(p)] its blocks are M, p x M and p x (p x M)', and its right
// side is (g, p x g).
struct PoseSums {
  Lanes m[5] = {};      // 00 20 11 21 22 of the upper left block; 10 is zero
  Lanes lower[9] = {};  // rotation rows, translation columns, column-major
  Lanes turn[6] = {};   // 00 10 20 11 21 22 of the lower right block
  Lanes b[6] = {};      // -gradient

  void add(const ProjectionLanes& q, const PointInformation& i) {
    m[0] += i.m00, m[1] += i.m02, m[2] += i.m11, m[3] += i.m12, m[4] += i.m22;
    const Lanes l00 = q.py * i.m02, l10 = q.pz * i.m00 - q.px * i.m02, l20 = -(q.py * i.m00);
    const Lanes l01 = q.py * i.m12 - q.pz * i.m11, l11 = -(q.px * i.m12), l21 = q.px * i.m11;
    const Lanes l02 = q.py * i.m22 - q.pz * i.m12, l12 = q.pz * i.m02 - q.px * i.m22,
                l22 = q.px * i.m12 - q.py * i.m02;
    lower[0] += l00, lower[1] += l10, lower[2] += l20;
    lower[3] += l01, lower[4] += l11, lower[5] += l21;
    lower[6] += l02, lower[7] += l12, lower[8] += l22;
    turn[0] += q.py * l02 - q.pz * l01;
    turn[1] += q.py * l12 - q.pz * l11;
    turn[2] += q.py * l22 - q.pz * l21;
    turn[3] += q.pz * l10 - q.px * l12;
    turn[4] += q.pz * l20 - q.px * l22;
    turn[5] += q.px * l21 - q.py * l20;
    b[0] += i.g0, b[1] += i.g1, b[2] += i.g2;
    b[3] += q.py * i.g2 - q.pz * i.g1;
    b[4] += q.pz * i.g0 - q.px * i.g2;
    b[5] += q.px * i.g1 - q.py * i.g0;
  }

  // Adds the lower half to `h` and the right side to `to_b`.
  template <typename Matrix, typename Vector>
  void add_to(Matrix&& h, Vector&& to_b) const {
    h(0, 0) += sum(m[0]), h(2, 0) += sum(m[1]), h(1, 1) += sum(m[2]), h(2, 1) += sum(m[3]),
        h(2, 2) += sum(m[4]);
    for (int k = 0; k < 9; ++k) h(3 + k % 3, k / 3) += sum(lower[k]);
    h(3, 3) += sum(turn[0]), h(4, 3) += sum(turn[1]), h(5, 3) += sum(turn[2]);
    h(4, 4) += sum(turn[3]), h(5, 4) += sum(turn[4]), h(5, 5) += sum(turn[5]);
    for (int k = 0; k < 6; ++k) to_b[k] += sum(b[k]);
  }
};

}  // namespace vsgraphs

#pragma GCC diagnostic pop
