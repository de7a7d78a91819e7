#include "core/solve/triangulate.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/solve/robust.h"

namespace vsgraphs {
namespace {

Eigen::Vector3d ray_in_world(const Intrinsics& k, const ViewOfPoint& view) {
  return (view.world_from_camera.rotation() * k.bearing(view.measurement.u, view.measurement.v)).normalized();
}

double largest_parallax(const Intrinsics& k, std::span<const ViewOfPoint> views) {
  double largest = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Eigen::Vector3d a = ray_in_world(k, views[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Vector3d b = ray_in_world(k, views[j]);
      largest = std::max(largest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return largest;
}

// Nearest point to all rays; readings of depth pull along theirs by their own accuracy in metres.
std::optional<Eigen::Vector3d> linear(const Intrinsics& k, std::span<const ViewOfPoint> views) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const ViewOfPoint& view : views) {
    const ReprojectionMeasurement& m = view.measurement;
    const Eigen::Vector3d ray = ray_in_world(k, view), centre = view.world_from_camera.translation();
    const double across = k.fx * m.inv_sigma_px;  // 1/rad; as good as 1/m at 1 m
    const Eigen::Matrix3d weight = across * across * (Eigen::Matrix3d::Identity() - ray * ray.transpose());
    a += weight;
    b += weight * centre;
    if (!m.has_depth()) continue;
    const Eigen::Vector3d axis = view.world_from_camera.rotation().col(2);
    const double along = m.inv_sigma_inverse_depth * m.inverse_depth * m.inverse_depth;  // 1/m
    a += along * along * axis * axis.transpose();
    b += along * along * axis * (axis.dot(centre) + 1.0 / m.inverse_depth);
  }
  const Eigen::LDLT<Eigen::Matrix3d> ldlt(a);
  const Eigen::Vector3d d = ldlt.vectorD();
  if (!(d.minCoeff() > 1e-10 * d.maxCoeff())) return {};
  return ldlt.solve(b);
}

template <int Rows>
bool add_rows(const Intrinsics& k, const ViewOfPoint& view, const Eigen::Vector3d& point, Eigen::Matrix3d& h,
              Eigen::Vector3d& b) {
  ReprojectionRows<Rows> rows;
  if (!reprojection(k, view.world_from_camera, point, view.measurement, rows)) return false;
  h += rows.by_point.transpose() * rows.by_point;
  b -= rows.by_point.transpose() * rows.residual;
  return true;
}

}  // namespace

std::optional<Eigen::Vector3d> triangulate(const Intrinsics& intrinsics, std::span<const ViewOfPoint> views,
                                           const TriangulationOptions& options) {
  const bool depth =
      std::any_of(views.begin(), views.end(), [](const auto& v) { return v.measurement.has_depth(); });
  if (!depth && (views.size() < 2 || !(largest_parallax(intrinsics, views) >= options.min_parallax_rad)))
    return {};
  std::optional<Eigen::Vector3d> point = linear(intrinsics, views);
  if (!point) return {};
  for (int step = 0; step < options.refinement_steps; ++step) {
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const ViewOfPoint& view : views) {
      const bool ok = view.measurement.has_depth() ? add_rows<3>(intrinsics, view, *point, h, b)
                                                   : add_rows<2>(intrinsics, view, *point, h, b);
      if (!ok) return {};
    }
    *point += h.ldlt().solve(b);
  }
  if (!point->allFinite()) return {};
  for (const ViewOfPoint& view : views) {
    const auto error = reprojection_error(intrinsics, view.world_from_camera, *point, view.measurement);
    const double gate = view.measurement.has_depth() ? chi2_95_3 : chi2_95_2;
    if (!error || !(error->chi2_px + error->chi2_depth <= gate)) return {};
  }
  return point;
}

double parallax_angle(const Eigen::Vector3d& point, const Eigen::Vector3d& centre_a,
                      const Eigen::Vector3d& centre_b) {
  const Eigen::Vector3d a = centre_a - point, b = centre_b - point;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::optional<ReprojectionError> reprojection_error(const Intrinsics& intrinsics,
                                                    const Se3& world_from_camera,
                                                    const Eigen::Vector3d& point,
                                                    const ReprojectionMeasurement& m) {
  const Eigen::Vector3d p =
      world_from_camera.rotation().transpose() * (point - world_from_camera.translation());
  if (!(p.z() >= min_projection_depth_m)) return {};
  const Eigen::Vector2d error = (intrinsics.project(p) - Eigen::Vector2d(m.u, m.v)) * m.inv_sigma_px;
  const double depth = m.has_depth() ? (1.0 / p.z() - m.inverse_depth) * m.inv_sigma_inverse_depth : 0.0;
  return ReprojectionError{error.squaredNorm(), depth * depth};
}

}  // namespace vsgraphs
