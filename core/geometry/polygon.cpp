#include "core/geometry/polygon.h"

#include <algorithm>
#include <limits>

namespace vsgraphs {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Distance between two closed segments that do not cross is reached at an end of one of them.
double segment_distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                        const Eigen::Vector2d& d) {
  const double ab_c = cross(b - a, c - a), ab_d = cross(b - a, d - a);
  const double cd_a = cross(d - c, a - c), cd_b = cross(d - c, b - c);
  if (ab_c * ab_d < 0 && cd_a * cd_b < 0) return 0;
  return std::min({distance_to_segment(c, a, b), distance_to_segment(d, a, b), distance_to_segment(a, c, d),
                   distance_to_segment(b, c, d)});
}

}  // namespace

double signed_area(const Polygon2& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

Eigen::Vector2d centroid(const Polygon2& polygon) {
  // Relative to the first vertex: the sums stay small far from the origin.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    const double w = cross(a, b);
    twice += w;
    sum += w * (a + b) / 3.0;
  }
  return polygon[0] + sum / twice;
}

bool is_simple(const Polygon2& polygon, double min_edge_m) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % n], &c = polygon[(i + 2) % n];
    if ((b - a).norm() < min_edge_m) return false;
    // A spike: the next edge runs back over this one.
    const bool folds_back = (b - a).dot(c - b) < 0;
    if (folds_back &&
        (distance_to_segment(c, a, b) < min_edge_m || distance_to_segment(a, b, c) < min_edge_m))
      return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // neighbours through the closing vertex
      if (segment_distance(a, b, polygon[j], polygon[(j + 1) % n]) < min_edge_m) return false;
    }
  }
  return true;
}

bool contains(const Polygon2& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

double distance_to_segment(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((point - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (point - a - t * ab).norm();
}

double distance_to_boundary(const Polygon2& polygon, const Eigen::Vector2d& point) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    best = std::min(best, distance_to_segment(point, polygon[i], polygon[(i + 1) % polygon.size()]));
  return best;
}

}  // namespace vsgraphs
