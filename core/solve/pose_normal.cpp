#include "core/solve/pose_normal.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // see lanes.h
#endif

namespace vsgraphs {

PoseRows::PoseRows(const Intrinsics& intrinsics, std::span<const PoseObservation> observations,
                   const PoseSolverOptions& options)
    : k_(intrinsics),
      count_(observations.size()),
      delta_px_(options.huber_px),
      delta_depth_(options.huber_depth),
      groups_((observations.size() + lane_count - 1) / lane_count) {
  for (Group& g : groups_) {
    g.z = lanes(1.0);
    g.seen.delta = lanes(delta_px_);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const PoseObservation& o = observations[i];
    Group& g = groups_[i / lane_count];
    const std::size_t k = i % lane_count;
    g.x[k] = o.point_in_world.x();
    g.y[k] = o.point_in_world.y();
    g.z[k] = o.point_in_world.z();
    g.seen.u[k] = o.u;
    g.seen.v[k] = o.v;
    g.seen.weight_px[k] = g.full_px[k] = o.inv_sigma_px;
    if (o.has_depth()) {
      g.seen.inverse_depth[k] = o.inverse_depth;
      g.seen.weight_depth[k] = g.full_depth[k] = o.inv_sigma_inverse_depth;
      g.seen.delta[k] = delta_depth_;
    }
  }
}

void PoseRows::accumulate(const Se3& world_from_camera, PoseNormal& out) const {
  PoseSums sums;
  Lanes cost = {};
  for (const Group& g : groups_) {
    const ProjectionLanes q = project(k_, world_from_camera, g.x, g.y, g.z, g.seen);
    cost += q.cost;
    sums.add(q, PointInformation(k_, g.seen, q));
  }
  Matrix6d lower = Matrix6d::Zero();
  sums.add_to(lower, out.b);
  out.h += lower.selfadjointView<Eigen::Lower>().toDenseMatrix();
  out.cost += 0.5 * sum(cost);
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
      const double ru = (k_.fx * p.x() / p.z() + k_.cx - g.seen.u[k]) * g.full_px[k];
      const double rv = (k_.fy * p.y() / p.z() + k_.cy - g.seen.v[k]) * g.full_px[k];
      const double rd = (1.0 / p.z() - g.seen.inverse_depth[k]) * g.full_depth[k];
      f = classify(ru * ru + rv * rv, rd * rd, has_depth);
      const bool depth_kept = f == ObservationFit::inlier && has_depth;
      if (is_inlier(f)) {
        squares += ru * ru + rv * rv + (depth_kept ? rd * rd : 0.0);
        rows += depth_kept ? 3 : 2;
      }
    }
    fit[i] = f;
    const bool with_depth = f == ObservationFit::inlier && has_depth;
    g.seen.weight_px[k] = is_inlier(f) ? g.full_px[k] : 0.0;
    g.seen.weight_depth[k] = with_depth ? g.full_depth[k] : 0.0;
    g.seen.delta[k] = with_depth ? delta_depth_ : delta_px_;
  }
}

}  // namespace vsgraphs
