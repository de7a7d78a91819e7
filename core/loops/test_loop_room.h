// A square room's surfaces as a keyframe keeps them, exact: depth grid and planar patches.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/camera.h"
#include "core/map/depth_grid.h"
#include "core/map/surface_patch.h"
#include "core/vision/test_rooms.h"

namespace vsgraphs::test {

// Its middle at the origin, 3 m high.
inline std::vector<Wall> square_room(double half_width_m) {
  return {{{1, 0, 0}, half_width_m},  {{-1, 0, 0}, half_width_m}, {{0, 0, 1}, half_width_m},
          {{0, 0, -1}, half_width_m}, {{0, 1, 0}, 1.5},           {{0, -1, 0}, 1.5}};
}

// What DepthSampler makes of an exact image, without the image.
inline DepthGrid grid_of(const Camera& camera, const Se3& in_room, const std::vector<Wall>& walls) {
  DepthGrid grid;
  grid.columns = camera.width / grid.step_px;
  grid.rows = camera.height / grid.step_px;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.columns; ++c) {
      const Eigen::Vector3d ray = camera.unproject((c + 0.5) * grid.step_px, (r + 0.5) * grid.step_px, 1.0);
      double depth_m = 1e9;
      SurfaceSample& sample = grid.samples.emplace_back();
      for (const Wall& wall : walls) {
        const Eigen::Vector3d normal = in_room.rotation().transpose() * wall.normal;
        const double speed = normal.dot(ray);
        const double there = (wall.offset_m - wall.normal.dot(in_room.translation())) / speed;
        if (speed <= 0 || there >= depth_m) continue;
        depth_m = there;
        sample = {(there * ray).cast<float>(), (-normal).cast<float>()};
      }
    }
  }
  return grid;
}

// The wall's part of a grid, turned about its middle by `turn_rad` about the vertical. Empty where little is seen of it.
inline std::optional<SurfacePatch> patch_on(const DepthGrid& grid, const Se3& in_room, const Wall& wall,
                                            double turn_rad) {
  SurfacePatch patch;
  const Eigen::Vector3d inward = in_room.rotation().transpose() * -wall.normal;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < grid.samples.size(); i += 7) {
    const SurfaceSample& s = grid.samples[i];
    if (!s.has_normal() || s.normal.dot(inward.cast<float>()) < 0.9F) continue;
    patch.points.push_back(s.point);
    sum += s.point.cast<double>();
  }
  if (patch.points.size() < 20) return std::nullopt;
  const Eigen::Vector3d middle = sum / static_cast<double>(patch.points.size());
  const Eigen::Matrix3d turn = so3_exp({0, turn_rad, 0});
  for (Eigen::Vector3f& p : patch.points) p = (middle + turn * (p.cast<double>() - middle)).cast<float>();
  patch.plane = {turn * inward, middle, 0};
  patch.information = Eigen::Matrix3d::Identity() * 1e4;
  patch.area_m2 = 2;
  return patch;
}

}  // namespace vsgraphs::test
