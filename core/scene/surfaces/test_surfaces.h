// Worlds of flat surfaces and what a depth camera sees of them, as a depth grid: for tests of what works on planes. The
// world's z points up unless a test tilts it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/rng.h"
#include "core/geometry/camera.h"
#include "core/geometry/plane.h"
#include "core/geometry/se3.h"
#include "core/map/depth_grid.h"

namespace vsgraphs::test {

// A parallelogram, seen from both sides.
struct Sheet {
  Eigen::Vector3d corner, a, b;

  // How many times `ray` from `eye` to the sheet; empty if it misses.
  std::optional<double> hit(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) const {
    const Eigen::Vector3d normal = a.cross(b);
    const double speed = normal.dot(ray);
    if (std::abs(speed) < 1e-12) return std::nullopt;
    const double at = normal.dot(corner - eye) / speed;
    const Eigen::Vector3d p = eye + at * ray - corner;
    const double s = p.cross(b).dot(normal) / normal.squaredNorm(),
                 t = a.cross(p).dot(normal) / normal.squaredNorm();
    if (at <= 0 || s < 0 || s > 1 || t < 0 || t > 1) return std::nullopt;
    return at;
  }
};

struct Ball {
  Eigen::Vector3d centre;
  double radius_m;

  std::optional<double> hit(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) const {
    const double a = ray.squaredNorm(), b = ray.dot(eye - centre);
    const double root = b * b - a * ((eye - centre).squaredNorm() - radius_m * radius_m);
    if (root < 0 || -b < std::sqrt(root)) return std::nullopt;
    return (-b - std::sqrt(root)) / a;
  }
};

struct World {
  std::vector<Sheet> sheets;
  std::vector<Ball> balls;

  World& sheet(const Eigen::Vector3d& corner, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    sheets.push_back({corner, a, b});
    return *this;
  }
  // Along the axes, closed.
  World& box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const Eigen::Vector3d size = high - low;
    const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    for (const Eigen::Vector3d& corner : {low, high}) {
      const double way = corner == low ? 1 : -1;
      sheet(corner, way * x, way * y).sheet(corner, way * y, way * z).sheet(corner, way * z, way * x);
    }
    return *this;
  }
  // Walls, floor and ceiling; box() seen from within.
  World& room(const Eigen::Vector3d& low, const Eigen::Vector3d& high) { return box(low, high); }
};

// world_from_camera of a camera at `eye` that looks at `target`; the image's up is as near to `up` as can be, then
// turned by `roll_rad` about the line of sight.
inline Se3 looking(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double roll_rad = 0,
                   const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ()) {
  Eigen::Matrix3d axes;
  axes.col(2) = (target - eye).normalized();
  axes.col(0) = axes.col(2).cross(up).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {axes * Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(), eye};
}

// As depth sampling makes it: from the points two steps away, none across edges and folds.
inline void add_normals(DepthGrid& grid, const DepthNoise& noise) {
  constexpr int reach = 2;
  for (int r = reach; r < grid.rows - reach; ++r) {
    for (int c = reach; c < grid.columns - reach; ++c) {
      auto& middle = grid.samples[static_cast<std::size_t>(r * grid.columns + c)];
      const Eigen::Vector3f &left = grid.at(c - reach, r).point, &right = grid.at(c + reach, r).point;
      const Eigen::Vector3f &above = grid.at(c, r - reach).point, &below = grid.at(c, r + reach).point;
      const Eigen::Vector3f& p = middle.point;
      if (p.z() <= 0 || left.z() <= 0 || right.z() <= 0 || above.z() <= 0 || below.z() <= 0) continue;
      const Eigen::Vector3f normal = (right - left).cross(above - below).normalized();
      const float limit = 2.5F * static_cast<float>(noise.sigma_m(static_cast<double>(p.z())));
      const auto far_off = [&](const Eigen::Vector3f& q) { return std::abs(normal.dot(q - p)) > limit; };
      if (far_off(left) || far_off(right) || far_off(above) || far_off(below)) continue;
      if (std::abs(normal.dot(p)) < 0.2F * p.norm()) continue;
      middle.normal = normal.dot(p) > 0 ? Eigen::Vector3f(-normal) : normal;
    }
  }
}

// What a camera sees. With `noise`: each depth errs by a normal error of the sensor's sigma there.
inline DepthGrid view(const World& world, const Se3& world_from_camera, const Camera& camera = {},
                      Rng* noise = nullptr) {
  DepthGrid grid;
  grid.columns = camera.width / grid.step_px;
  grid.rows = camera.height / grid.step_px;
  grid.samples.resize(static_cast<std::size_t>(grid.columns * grid.rows));
  const Eigen::Vector3d& eye = world_from_camera.translation();
  for (int i = 0; i < grid.columns * grid.rows; ++i) {
    const Eigen::Vector3d ray = camera.unproject((i % grid.columns + 0.5) * grid.step_px,
                                                 (i / grid.columns + 0.5) * grid.step_px, 1.0);
    double depth = std::numeric_limits<double>::infinity();
    const auto nearer = [&](const auto& thing) {
      if (const auto at = thing.hit(eye, world_from_camera.rotation() * ray)) depth = std::min(depth, *at);
    };
    for (const Sheet& sheet : world.sheets) nearer(sheet);
    for (const Ball& ball : world.balls) nearer(ball);
    if (depth > camera.depth_max_m) continue;
    if (noise) depth += noise->normal() * camera.depth_noise.sigma_m(depth);
    if (depth >= camera.depth_min_m)
      grid.samples[static_cast<std::size_t>(i)].point = (depth * ray).cast<float>();
  }
  add_normals(grid, camera.depth_noise);
  return grid;
}

// The plane through `point`, on the side `normal` points to.
inline AnchoredPlane plane_at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  return {normal.normalized(), point, 0};
}

}  // namespace vsgraphs::test
