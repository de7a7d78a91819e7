#include "core/scene/plane_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsgraphs {
namespace {

constexpr double min_behind_m = 0.08, max_range_m = 6.0, on_sigmas = 3.0, behind_sigmas = 4.0,
                 min_facing = 0.85, farthest_m = 100.0;

void count(std::uint16_t& counter) {
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
  count(cells_[c].on);
  box_.add(c);
  seen_ = true;
}

void PlaneEvidence::expect(const std::vector<Eigen::Vector3d>& points) {
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector2d at = frame_.coordinates(point);
    box_.add(cell_at(at.x(), at.y(), cell_m));
  }
}

void PlaneEvidence::integrate(const AnchoredPlane& plane, const DepthGrid& grid, const Se3& world_from_camera,
                              const DepthNoise& noise, bool observes_it) {
  const Box before = box_;                     // a surface that goes on from it must not draw it along
  if (!observes_it && before.empty()) return;  // not seen yet
  const double from_camera = plane.signed_distance(world_from_camera.translation());
  if (from_camera < 0.1 || from_camera > max_range_m)
    return;  // seen from behind, from within, or out of reach
  const Eigen::Vector3d normal = world_from_camera.rotation().transpose() * plane.normal;
  std::vector<Cell> passed;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = r % 2; c < grid.columns; c += 2) {
      const SurfaceSample& sample = grid.at(c, r);
      const Eigen::Vector3d point = sample.point.cast<double>();
      if (point.z() <= 0 || point.z() > max_range_m) continue;
      const double distance = from_camera + normal.dot(point);
      const double sigma = noise.sigma_m(point.z());
      // Where other surfaces cut the plane there are points on it too, but they face elsewhere.
      const bool facing = sample.normal.cast<double>().dot(normal) > min_facing;
      const bool on = facing && std::abs(distance) < std::max(0.03, on_sigmas * sigma);
      const bool behind = distance < -std::max(min_behind_m, behind_sigmas * sigma);
      if (!on && !behind) continue;
      const Eigen::Vector3d meets = world_from_camera * (point * (from_camera / (from_camera - distance)));
      const Eigen::Vector2d at = frame_.coordinates(meets);
      // Rays that graze the plane meet it far off.
      if (at.cwiseAbs().maxCoeff() > farthest_m) continue;
      const Cell cell = cell_at(at.x(), at.y(), cell_m);
      if (!on)
        passed.push_back(cell);
      else if (observes_it || before.near(cell, own_margin))
        count_on(cell);
    }
  }
  if (box_.empty()) return;
  constexpr int margin = static_cast<int>(margin_m / cell_m);
  for (const Cell& c : passed) {
    if (box_.near(c, margin)) count(cells_[c].through);
  }
}

void PlaneEvidence::add(const PlaneEvidence& other) {
  const auto& cells = other.cells_;
  for (int t = cells.min_t(); t < cells.end_t(); ++t) {
    for (int s = cells.min_s(); s < cells.end_s(); ++s) {
      const CellEvidence e = cells.at({s, t});
      if (e.on == 0 && e.through == 0) continue;
      const Eigen::Vector2d at =
          frame_.coordinates(other.frame_.point((s + 0.5) * cell_m, (t + 0.5) * cell_m));
      if (at.cwiseAbs().maxCoeff() > 2 * farthest_m) continue;
      const Cell cell = cell_at(at.x(), at.y(), cell_m);
      if (e.on > 0) count_on(cell);
      CellEvidence& mine = cells_[cell];
      const auto sum = [](int a, int b) {
        return static_cast<std::uint16_t>(std::min(a + b, int{std::numeric_limits<std::uint16_t>::max()}));
      };
      mine.on = sum(mine.on, std::max(0, e.on - 1));
      mine.through = sum(mine.through, e.through);
    }
  }
}

}  // namespace vsgraphs
