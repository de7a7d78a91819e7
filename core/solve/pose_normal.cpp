#include "core/solve/pose_normal.h"

#include "core/solve/factors/reprojection.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // see lanes.h
#endif

namespace vsgraphs {
namespace {

// A point behind the camera costs this constant and pulls nowhere.
constexpr double invalid_chi2 = 1e4;

struct Camera4 {
  Lanes r[3][3], t[3];
  explicit Camera4(const Se3& pose) {
    for (int i = 0; i < 3; ++i) {
      t[i] = lanes(pose.translation()[i]);
      for (int k = 0; k < 3; ++k) r[i][k] = lanes(pose.rotation()(i, k));
    }
  }
};

}  // namespace

PoseRows::PoseRows(const Intrinsics& intrinsics, std::span<const PoseObservation> observations,
                   const PoseSolverOptions& options)
    : k_(intrinsics),
      count_(observations.size()),
      delta_px_(options.huber_px),
      delta_depth_(options.huber_depth),
      groups_((observations.size() + lane_count - 1) / lane_count) {
  for (Group& g : groups_) {
    g.z = lanes(1.0);
    g.delta = lanes(delta_px_);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const PoseObservation& o = observations[i];
    Group& g = groups_[i / lane_count];
    const std::size_t k = i % lane_count;
    g.x[k] = o.point_in_world.x();
    g.y[k] = o.point_in_world.y();
    g.z[k] = o.point_in_world.z();
    g.u[k] = o.u;
    g.v[k] = o.v;
    g.weight_px[k] = g.full_px[k] = o.inv_sigma_px;
    if (o.has_depth()) {
      g.inverse_depth[k] = o.inverse_depth;
      g.weight_depth[k] = g.full_depth[k] = o.inv_sigma_inverse_depth;
      g.delta[k] = delta_depth_;
    }
  }
}

void PoseRows::accumulate(const Se3& world_from_camera, PoseNormal& sum_out) const {
  const Camera4 c(world_from_camera);
  const Lanes fx = lanes(k_.fx), fy = lanes(k_.fy), cx = lanes(k_.cx), cy = lanes(k_.cy);
  const Lanes nearest = lanes(min_projection_depth_m), zero = lanes(0), one = lanes(1);
  // Only the entries that differ: h01 = 0 as u does not depend on y nor v on x.
  Lanes h[20] = {}, b[6] = {}, cost = {};
  for (const Group& g : groups_) {
    const Lanes dx = g.x - c.t[0], dy = g.y - c.t[1], dz = g.z - c.t[2];
    const Lanes pz = c.r[0][2] * dx + c.r[1][2] * dy + c.r[2][2] * dz;
    const auto valid = pz >= nearest;
    const Lanes iz = one / (valid ? pz : one);
    const Lanes x = (c.r[0][0] * dx + c.r[1][0] * dy + c.r[2][0] * dz) * iz;
    const Lanes y = (c.r[0][1] * dx + c.r[1][1] * dy + c.r[2][1] * dz) * iz;
    const Lanes wu = fx * g.weight_px, wv = fy * g.weight_px, wd = g.weight_depth * iz;
    const Lanes ru = wu * x + (cx - g.u) * g.weight_px, rv = wv * y + (cy - g.v) * g.weight_px;
    const Lanes rd = (iz - g.inverse_depth) * g.weight_depth;
    const auto used = g.weight_px > zero;
    const Lanes chi2 = valid ? ru * ru + rv * rv + rd * rd : (used ? lanes(invalid_chi2) : zero);
    const Lanes d2 = g.delta * g.delta;
    const Lanes norm = sqrt(max(chi2, d2));
    cost += chi2 > d2 ? lanes(2) * g.delta * norm - d2 : chi2;
    const Lanes w = valid ? g.delta / norm : zero;
    // Rows of J over (rho, phi): u: wu (-iz, 0, x iz, x y, -(1 + x^2), y); v: wv (0, -iz, y iz, 1 + y^2, -x y, -x);
    // depth: wd (0, 0, iz, y, -x, 0) with wd holding one 1/z already.
    const Lanes xy = x * y;
    const Lanes u0 = -wu * iz, u2 = -u0 * x, u3 = wu * xy, u4 = -wu * (one + x * x), u5 = wu * y;
    const Lanes v1 = -wv * iz, v2 = -v1 * y, v3 = wv * (one + y * y), v4 = -wv * xy, v5 = -wv * x;
    const Lanes e2 = wd * iz, e3 = wd * y, e4 = -wd * x;
    const Lanes a0 = w * u0, a2 = w * u2, a3 = w * u3, a4 = w * u4, a5 = w * u5;
    const Lanes c1 = w * v1, c2 = w * v2, c3 = w * v3, c4 = w * v4, c5 = w * v5;
    const Lanes f2 = w * e2, f3 = w * e3, f4 = w * e4;
    h[0] += a0 * u0;
    h[1] += a0 * u2;
    h[2] += a0 * u3;
    h[3] += a0 * u4;
    h[4] += a0 * u5;
    h[5] += c1 * v1;
    h[6] += c1 * v2;
    h[7] += c1 * v3;
    h[8] += c1 * v4;
    h[9] += c1 * v5;
    h[10] += a2 * u2 + c2 * v2 + f2 * e2;
    h[11] += a2 * u3 + c2 * v3 + f2 * e3;
    h[12] += a2 * u4 + c2 * v4 + f2 * e4;
    h[13] += a2 * u5 + c2 * v5;
    h[14] += a3 * u3 + c3 * v3 + f3 * e3;
    h[15] += a3 * u4 + c3 * v4 + f3 * e4;
    h[16] += a3 * u5 + c3 * v5;
    h[17] += a4 * u4 + c4 * v4 + f4 * e4;
    h[18] += a4 * u5 + c4 * v5;
    h[19] += a5 * u5 + c5 * v5;
    b[0] -= a0 * ru;
    b[1] -= c1 * rv;
    b[2] -= a2 * ru + c2 * rv + f2 * rd;
    b[3] -= a3 * ru + c3 * rv + f3 * rd;
    b[4] -= a4 * ru + c4 * rv + f4 * rd;
    b[5] -= a5 * ru + c5 * rv;
  }
  constexpr int row[20] = {0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 4, 4, 5};
  constexpr int col[20] = {0, 2, 3, 4, 5, 1, 2, 3, 4, 5, 2, 3, 4, 5, 3, 4, 5, 4, 5, 5};
  for (int i = 0; i < 20; ++i) {
    const double s = sum(h[i]);
    sum_out.h(row[i], col[i]) += s;
    if (row[i] != col[i]) sum_out.h(col[i], row[i]) += s;
  }
  for (int i = 0; i < 6; ++i) sum_out.b[i] += sum(b[i]);
  sum_out.cost += 0.5 * sum(cost);
}

void PoseRows::classify_all(const Se3& world_from_camera, std::vector<ObservationFit>& fit, double& squares,
                            int& rows) {
  fit.resize(count_);
  squares = 0;
  rows = 0;
  const Eigen::Matrix3d camera_from_world = world_from_camera.rotation().transpose();
  for (std::size_t i = 0; i < count_; ++i) {
    Group& g = groups_[i / lane_count];
    const std::size_t k = i % lane_count;
    const Eigen::Vector3d p =
        camera_from_world * (Eigen::Vector3d(g.x[k], g.y[k], g.z[k]) - world_from_camera.translation());
    const bool has_depth = g.full_depth[k] > 0;
    ObservationFit f = ObservationFit::outlier;
    if (p.z() >= min_projection_depth_m) {
      const double ru = (k_.fx * p.x() / p.z() + k_.cx - g.u[k]) * g.full_px[k];
      const double rv = (k_.fy * p.y() / p.z() + k_.cy - g.v[k]) * g.full_px[k];
      const double rd = (1.0 / p.z() - g.inverse_depth[k]) * g.full_depth[k];
      f = classify(ru * ru + rv * rv, rd * rd, has_depth);
      const bool depth_kept = f == ObservationFit::inlier && has_depth;
      if (is_inlier(f)) {
        squares += ru * ru + rv * rv + (depth_kept ? rd * rd : 0.0);
        rows += depth_kept ? 3 : 2;
      }
    }
    fit[i] = f;
    const bool with_depth = f == ObservationFit::inlier && has_depth;
    g.weight_px[k] = is_inlier(f) ? g.full_px[k] : 0.0;
    g.weight_depth[k] = with_depth ? g.full_depth[k] : 0.0;
    g.delta[k] = with_depth ? delta_depth_ : delta_px_;
  }
}

}  // namespace vsgraphs
