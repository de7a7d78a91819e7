#include "core/vision/depth_sampling.h"

#include <Eigen/Geometry>
#include <cmath>

namespace vsgraphs {

DepthSampler::DepthSampler(const Camera& camera)
    : camera_(camera), lookup_(camera), columns_(camera.width / step_px), rows_(camera.height / step_px) {
  rays_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      const Eigen::Vector2d pixel = camera.undistort({c * step_px + step_px / 2, r * step_px + step_px / 2});
      rays_.push_back(camera.unproject(pixel.x(), pixel.y(), 1.0).cast<float>());
    }
  }
}

double DepthSampler::smoothed_depth(const DepthView& depth, int u, int v) const {
  const double middle = lookup_.pixel(depth, u, v);
  if (middle <= 0) return 0;
  const double tolerance = 3.0 * camera_.depth_noise.sigma_m(middle);
  double sum = 0;
  int count = 0;
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      const double z = lookup_.pixel(depth, u + du, v + dv);
      if (std::abs(z - middle) > tolerance) continue;
      sum += z;
      ++count;
    }
  }
  return sum / count;
}

DepthGrid DepthSampler::sample(const DepthView& depth) const {
  DepthGrid grid;
  grid.step_px = step_px;
  grid.columns = columns_;
  grid.rows = rows_;
  grid.samples.resize(rays_.size());
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      const auto i =
          static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
      const double z = smoothed_depth(depth, c * step_px + step_px / 2, r * step_px + step_px / 2);
      grid.samples[i].point = rays_[i] * static_cast<float>(z);
    }
  }
  add_normals(grid);
  return grid;
}

void DepthSampler::add_normals(DepthGrid& grid) const {
  constexpr int reach = 2;
  for (int r = reach; r < rows_ - reach; ++r) {
    for (int c = reach; c < columns_ - reach; ++c) {
      const Eigen::Vector3f& middle = grid.at(c, r).point;
      const Eigen::Vector3f &left = grid.at(c - reach, r).point, &right = grid.at(c + reach, r).point;
      const Eigen::Vector3f &up = grid.at(c, r - reach).point, &down = grid.at(c, r + reach).point;
      if (middle.z() <= 0 || left.z() <= 0 || right.z() <= 0 || up.z() <= 0 || down.z() <= 0) continue;
      Eigen::Vector3f normal = (right - left).cross(up - down);
      const float length = normal.norm();
      if (length <= 0) continue;
      normal /= length;
      // An edge or a fold: the five points are not on one plane.
      const auto sigma = static_cast<float>(camera_.depth_noise.sigma_m(static_cast<double>(middle.z())));
      const auto off = [&](const Eigen::Vector3f& p) { return std::abs(normal.dot(p - middle)); };
      const float limit = 2.5F * sigma;
      if (off(left) > limit || off(right) > limit || off(up) > limit || off(down) > limit) continue;
      // Grazing surfaces carry mostly noise.
      if (std::abs(normal.dot(middle)) < 0.2F * middle.norm()) continue;
      const auto i =
          static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
      grid.samples[i].normal = normal.dot(middle) > 0 ? Eigen::Vector3f(-normal) : normal;
    }
  }
}

const SurfaceSample* DepthSampler::look_up(const DepthGrid& grid, const Eigen::Vector3d& point) const {
  if (point.z() < 0.05) return nullptr;
  Eigen::Vector2d pixel = camera_.project(point);
  if (!camera_.contains(pixel.x(), pixel.y())) return nullptr;
  if (camera_.distorted()) pixel = camera_.distort(pixel);
  const int c = static_cast<int>(std::floor(pixel.x() / step_px)),
            r = static_cast<int>(std::floor(pixel.y() / step_px));
  if (c < 0 || r < 0 || c >= grid.columns || r >= grid.rows) return nullptr;
  return &grid.at(c, r);
}

}  // namespace vsgraphs
