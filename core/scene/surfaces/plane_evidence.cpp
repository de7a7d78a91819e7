#include "core/scene/surfaces/plane_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/surfaces/moved_cells.h"

namespace vsgraphs {
namespace {

constexpr double min_behind_m = 0.08, on_sigmas = 3.0, behind_sigmas = 4.0, min_facing = 0.85,
                 farthest_m = 100.0;

void count_up(std::uint16_t& counter) {
  if (counter < std::numeric_limits<std::uint16_t>::max()) ++counter;
}

}  // namespace

void PlaneEvidence::Box::add(Cell c) {
  if (empty()) {
    low = high = c;
    return;
  }
  low = {std::min(low.s, c.s), std::min(low.t, c.t)};
  high = {std::max(high.s, c.s), std::max(high.t, c.t)};
}

void PlaneEvidence::count_on(Cell c) {
  count_up(cells_[c].on);
  box_.add(c);
  seen_ = true;
}

void PlaneEvidence::expect(const std::vector<Eigen::Vector3d>& points) {
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector2d at = frame_.coordinates(point);
    box_.add(cell_at(at.x(), at.y(), cell_m));
  }
}

MetRays rays_that_meet(const AnchoredPlane& plane, const DepthGrid& grid, const Se3& world_from_camera,
                       const DepthNoise& noise) {
  MetRays met;
  const double from_camera = plane.signed_distance(world_from_camera.translation());
  // Seen from behind, from within, or out of reach.
  if (from_camera < 0.1 || from_camera > PlaneEvidence::max_range_m) return met;
  const Eigen::Vector3d normal = world_from_camera.rotation().transpose() * plane.normal;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = r % 2; c < grid.columns; c += 2) {
      const SurfaceSample& sample = grid.at(c, r);
      const Eigen::Vector3d point = sample.point.cast<double>();
      if (point.z() <= 0 || point.z() > PlaneEvidence::max_range_m) continue;
      const double distance = from_camera + normal.dot(point);
      const double sigma = noise.sigma_m(point.z());
      // Where other surfaces cut the plane there are points on it too, but they face elsewhere.
      const bool facing = sample.normal.cast<double>().dot(normal) > min_facing;
      const bool on = facing && std::abs(distance) < std::max(0.03, on_sigmas * sigma);
      const bool behind = distance < -std::max(min_behind_m, behind_sigmas * sigma);
      if (!on && !behind) continue;
      (on ? met.on : met.through)
          .push_back(world_from_camera * (point * (from_camera / (from_camera - distance))));
    }
  }
  return met;
}

// Rays that graze the plane meet it far off.
std::optional<Cell> PlaneEvidence::cell_of(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d at = frame_.coordinates(point);
  if (at.cwiseAbs().maxCoeff() > farthest_m) return std::nullopt;
  return cell_at(at.x(), at.y(), cell_m);
}

MetRays PlaneEvidence::count(const MetRays& rays, bool observes_it) {
  MetRays counted;
  const Box before = box_;  // a surface that goes on from it must not draw it along
  if (!observes_it && before.empty()) return counted;  // not seen yet
  for (const Eigen::Vector3d& point : rays.on) {
    const auto cell = cell_of(point);
    if (!cell || (!observes_it && !before.near(*cell, own_margin))) continue;
    count_on(*cell);
    counted.on.push_back(point);
  }
  if (box_.empty()) return counted;
  constexpr int margin = static_cast<int>(margin_m / cell_m);
  for (const Eigen::Vector3d& point : rays.through) {
    const auto cell = cell_of(point);
    if (!cell || !box_.near(*cell, margin)) continue;
    count_up(cells_[*cell].through);
    counted.through.push_back(point);
  }
  return counted;
}

void PlaneEvidence::count_all(const MetRays& rays) {
  for (const Eigen::Vector3d& point : rays.on) {
    if (const auto cell = cell_of(point)) count_on(*cell);
  }
  for (const Eigen::Vector3d& point : rays.through) {
    if (const auto cell = cell_of(point)) count_up(cells_[*cell].through);
  }
}

void PlaneEvidence::integrate(const AnchoredPlane& plane, const DepthGrid& grid, const Se3& world_from_camera,
                              const DepthNoise& noise, bool observes_it) {
  count(rays_that_meet(plane, grid, world_from_camera, noise), observes_it);
}

void PlaneEvidence::add(const PlaneEvidence& other) {
  const auto sum = [](int a, int b) {
    return static_cast<std::uint16_t>(std::min(a + b, int{std::numeric_limits<std::uint16_t>::max()}));
  };
  for_moved_cells(other.cells_, other.frame_, frame_, cell_m, [&](Cell cell, const CellEvidence& e) {
    CellEvidence& mine = cells_[cell];
    mine = {sum(mine.on, e.on), sum(mine.through, e.through)};
    if (e.on == 0) return;
    box_.add(cell);
    seen_ = true;
  });
}

}  // namespace vsgraphs
