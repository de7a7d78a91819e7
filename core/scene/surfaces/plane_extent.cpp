#include "core/scene/surfaces/plane_extent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/scene/surfaces/moved_cells.h"

namespace vsgraphs {

PlaneFrame frame_of(const AnchoredPlane& plane, const std::optional<Eigen::Vector3d>& up) {
  constexpr double level = 0.5;  // cosine: nearer to level than this, "up" does not lie in the plane
  PlaneFrame frame;
  frame.origin = plane.project(plane.anchor);
  if (up && std::abs(plane.normal.dot(*up)) < level) {
    frame.t = (*up - up->dot(plane.normal) * plane.normal).normalized();
    frame.s = frame.t.cross(plane.normal);
  } else {
    const auto basis = tangent_basis(plane.normal);
    frame.s = basis.col(0);
    frame.t = basis.col(1);
  }
  return frame;
}

void PlaneExtent::count(const Eigen::Vector3d& point, int change) {
  const Eigen::Vector2d c = frame_.coordinates(point);
  if (!(c.cwiseAbs().maxCoeff() < farthest_m)) return;
  std::uint16_t& cell = cells_[cell_at(c.x(), c.y(), cell_m)];
  const int before = cell;
  cell = static_cast<std::uint16_t>(
      std::clamp(before + change, 0, int{std::numeric_limits<std::uint16_t>::max()}));
  count_ += (cell != 0) - (before != 0);
}

void PlaneExtent::add(const PlaneExtent& other) {
  for_moved_cells(other.cells_, other.frame_, frame_, cell_m, [this](Cell at, std::uint16_t points) {
    std::uint16_t& cell = cells_[at];
    count_ += cell == 0;
    cell =
        static_cast<std::uint16_t>(std::min(cell + points, int{std::numeric_limits<std::uint16_t>::max()}));
  });
}

std::vector<Eigen::Vector3d> PlaneExtent::points() const {
  std::vector<Eigen::Vector3d> points;
  for (int t = cells_.min_t(); t < cells_.end_t(); ++t) {
    for (int s = cells_.min_s(); s < cells_.end_s(); ++s) {
      if (cells_.at({s, t})) points.push_back(frame_.point((s + 0.5) * cell_m, (t + 0.5) * cell_m));
    }
  }
  return points;
}

Eigen::Vector3d PlaneExtent::centre() const {
  if (empty()) return frame_.origin;
  int low_s = cells_.end_s(), high_s = cells_.min_s(), low_t = cells_.end_t(), high_t = cells_.min_t();
  for (int t = cells_.min_t(); t < cells_.end_t(); ++t) {
    for (int s = cells_.min_s(); s < cells_.end_s(); ++s) {
      if (!cells_.at({s, t})) continue;
      low_s = std::min(low_s, s), high_s = std::max(high_s, s);
      low_t = std::min(low_t, t), high_t = std::max(high_t, t);
    }
  }
  return frame_.point(0.5 * cell_m * (low_s + high_s + 1), 0.5 * cell_m * (low_t + high_t + 1));
}

bool PlaneExtent::near(const Eigen::Vector3d& point, double reach_m) const {
  const Eigen::Vector2d c = frame_.coordinates(point);
  const Cell low = cell_at(c.x() - reach_m, c.y() - reach_m, cell_m);
  const Cell high = cell_at(c.x() + reach_m, c.y() + reach_m, cell_m);
  for (int t = std::max(low.t, cells_.min_t()); t <= std::min(high.t, cells_.end_t() - 1); ++t) {
    for (int s = std::max(low.s, cells_.min_s()); s <= std::min(high.s, cells_.end_s() - 1); ++s) {
      if (cells_.at({s, t})) return true;
    }
  }
  return false;
}

double PlaneExtent::share_near(const std::vector<Eigen::Vector3d>& points, double reach_m) const {
  if (points.empty()) return 0;
  const auto count =
      std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) { return near(p, reach_m); });
  return static_cast<double>(count) / static_cast<double>(points.size());
}

}  // namespace vsgraphs
