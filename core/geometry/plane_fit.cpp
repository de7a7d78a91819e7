#include "core/geometry/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace vsgraphs {

double normal_sigma_m(const Camera& camera, const SurfaceNoise& noise, const Eigen::Vector3d& point,
                      const Eigen::Vector3d& normal) {
  const double depth = point.z();
  const double along_ray = camera.depth_noise.sigma_m(depth) * normal.dot(point) / depth;
  const double across = noise.pixel_px * depth * std::hypot(normal.x() / camera.fx, normal.y() / camera.fy);
  return std::hypot(along_ray, across, noise.model_m);
}

void PlaneSums::add(const Eigen::Vector3d& point, double weight) {
  ++count_;
  weight_ += weight;
  first_ += weight * point;
  second_ += weight * point * point.transpose();
}

PlaneSums& PlaneSums::operator+=(const PlaneSums& other) {
  count_ += other.count_;
  weight_ += other.weight_;
  first_ += other.first_;
  second_ += other.second_;
  return *this;
}

double PlaneSums::rms_m(const AnchoredPlane& plane) const {
  const double d = plane.d();
  const Eigen::Vector3d& n = plane.normal;
  const double sum = n.dot(second_ * n) + 2 * d * n.dot(first_) + d * d * weight_;
  return std::sqrt(std::max(sum, 0.0) / weight_);
}

std::optional<PlaneFit> PlaneSums::fit(double effective_count, const Eigen::Vector3d& viewpoint) const {
  constexpr double line = 1e-12;  // second largest spread over the largest, squared: rounding alone
  if (count_ < 3 || !(weight_ > 0) || !second_.allFinite()) return std::nullopt;
  const Eigen::Vector3d centroid = first_ / weight_;
  const Eigen::Matrix3d scatter = second_ - first_ * centroid.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  const Eigen::Vector3d spread = axes.eigenvalues();
  if (!(spread[1] > line * std::max(spread[2], weight_ * centroid.squaredNorm()))) return std::nullopt;

  PlaneFit fit;
  AnchoredPlane& plane = fit.estimate.plane;
  plane.anchor = centroid;
  plane.normal = axes.eigenvectors().col(0).normalized();
  if (plane.normal.dot(viewpoint - centroid) < 0) plane.normal = -plane.normal;
  fit.rms_m = std::sqrt(std::max(spread[0], 0.0) / weight_);

  // J'GJ at the centroid, where tilts and offset are independent.
  const double worth =
      effective_count > 0 ? std::min(1.0, effective_count / static_cast<double>(count_)) : 1.0;
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(plane.normal);
  fit.estimate.information.topLeftCorner<2, 2>() = worth * basis.transpose() * scatter * basis;
  fit.estimate.information(2, 2) = worth * weight_;
  return fit;
}

}  // namespace vsgraphs
