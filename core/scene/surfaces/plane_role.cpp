#include "core/scene/surfaces/plane_role.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vsgraphs {
namespace {

constexpr double cell_m = PlaneEvidence::cell_m;
constexpr int reach = 4;  // cells beyond an edge in which open ones are looked for

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

// Is the edge cell followed by open cells in direction (ds, dt)?
bool ends_open(const PlaneEvidence& evidence, Cell edge, int ds, int dt) {
  int open = 0;
  for (int k = 1; k <= reach; ++k) open += evidence.open({edge.s + k * ds, edge.t + k * dt});
  return open >= 2;
}

struct Span {
  int low = 0, high = -1;
  bool empty() const { return high < low; }
};

Span solid_rows(const PlaneEvidence& evidence, int s) {
  Span span{evidence.cells().end_t(), evidence.cells().min_t() - 1};
  for (int t = evidence.cells().min_t(); t < evidence.cells().end_t(); ++t) {
    if (!evidence.solid({s, t})) continue;
    span.low = std::min(span.low, t);
    span.high = t;
  }
  return span;
}

// Over the rows, the share in which the outermost solid cell towards `ds` is followed by open ones.
double open_side(const PlaneEvidence& evidence, int ds) {
  const auto& cells = evidence.cells();
  int rows = 0, open = 0;
  for (int t = cells.min_t(); t < cells.end_t(); ++t) {
    const int first = ds > 0 ? cells.end_s() - 1 : cells.min_s();
    for (int s = first; s >= cells.min_s() && s < cells.end_s(); s -= ds) {
      if (!evidence.solid({s, t})) continue;
      ++rows;
      open += ends_open(evidence, {s, t}, ds, 0);
      break;
    }
  }
  return rows > 0 ? static_cast<double>(open) / rows : 0;
}

}  // namespace

UprightShape shape_of(const PlaneEvidence& evidence) {
  UprightShape shape;
  const auto& cells = evidence.cells();
  std::vector<double> lows, highs, open_tops;
  for (int s = cells.min_s(); s < cells.end_s(); ++s) {
    const Span rows = solid_rows(evidence, s);
    if (rows.empty()) continue;
    for (int t = rows.low; t <= rows.high; ++t) shape.area_m2 += evidence.solid({s, t}) * cell_m * cell_m;
    lows.push_back(rows.low * cell_m);
    highs.push_back((rows.high + 1) * cell_m);
    if (ends_open(evidence, {s, rows.high}, 0, 1)) open_tops.push_back(highs.back());
  }
  if (lows.empty()) return shape;
  shape.width_m = static_cast<double>(lows.size()) * cell_m;
  shape.low_m = quantile(lows, 0.05);
  shape.high_m = quantile(highs, 0.95);
  shape.open_top_share = static_cast<double>(open_tops.size()) / static_cast<double>(lows.size());
  shape.open_top_m = quantile(open_tops, 0.5);
  shape.open_left = open_side(evidence, -1);
  shape.open_right = open_side(evidence, 1);
  return shape;
}

double open_outline_share(const PlaneEvidence& evidence) {
  const auto& cells = evidence.cells();
  int outline = 0, open = 0;
  for (int t = cells.min_t(); t < cells.end_t(); ++t) {
    for (int s = cells.min_s(); s < cells.end_s(); ++s) {
      if (!evidence.solid({s, t})) continue;
      for (const auto& [ds, dt] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (evidence.solid({s + ds, t + dt})) continue;
        ++outline;
        open += ends_open(evidence, {s, t}, ds, dt);
      }
    }
  }
  return outline > 0 ? static_cast<double>(open) / outline : 0;
}

namespace {

// Share of the surface's columns for which `holds(column of the larger one)`.
template <typename Holds>
double share_of_columns(const PlaneEvidence& surface, const PlaneEvidence& larger, Holds holds) {
  const auto& cells = surface.cells();
  int columns = 0, held = 0;
  for (int s = cells.min_s(); s < cells.end_s(); ++s) {
    const Span rows = solid_rows(surface, s);
    if (rows.empty()) continue;
    ++columns;
    const Eigen::Vector3d middle =
        surface.frame().point((s + 0.5) * cell_m, 0.5 * cell_m * (rows.low + rows.high + 1));
    held += holds(static_cast<int>(std::floor(larger.frame().coordinates(middle).x() / cell_m)));
  }
  return columns > 0 ? static_cast<double>(held) / columns : 0;
}

}  // namespace

double width_shared_with(const PlaneEvidence& surface, const PlaneEvidence& larger) {
  constexpr int enough = 2;
  return share_of_columns(surface, larger, [&](int column) {
    int solid = 0;
    for (int t = larger.cells().min_t(); t < larger.cells().end_t(); ++t) solid += larger.solid({column, t});
    return solid >= enough;
  });
}

double width_within(const PlaneEvidence& surface, const PlaneEvidence& larger) {
  Span span{larger.cells().end_s(), larger.cells().min_s() - 1};
  for (int s = larger.cells().min_s(); s < larger.cells().end_s(); ++s) {
    if (solid_rows(larger, s).empty()) continue;
    span.low = std::min(span.low, s);
    span.high = s;
  }
  return share_of_columns(surface, larger,
                          [&](int column) { return column >= span.low && column <= span.high; });
}

double farthest_from(const AnchoredPlane& plane, const PlaneEvidence& surface) {
  double farthest = 0;
  const auto& cells = surface.cells();
  for (int t = cells.min_t(); t < cells.end_t(); ++t) {
    for (int s = cells.min_s(); s < cells.end_s(); ++s) {
      if (!surface.solid({s, t})) continue;
      const Eigen::Vector3d middle = surface.frame().point((s + 0.5) * cell_m, (t + 0.5) * cell_m);
      farthest = std::max(farthest, std::abs(plane.signed_distance(middle)));
    }
  }
  return farthest;
}

bool larger_is_the_wall(const JudgedSurface& surface, const JudgedSurface& larger, double max_angle_rad) {
  constexpr double nearest_m = 0.03, farthest_m = 0.8, more = 1.3, most = 0.5;
  constexpr double hung_m = 0.25, hung_rad = 0.45, much_more = 3.0, nearly_all = 0.8;
  const double cosine = surface.plane.normal.dot(larger.plane.normal);
  if (cosine < std::cos(std::max(max_angle_rad, hung_rad))) return false;
  const double area = shape_of(surface.evidence).area_m2, larger_area = shape_of(larger.evidence).area_m2;
  if (larger_area < more * area) return false;
  const double gap = std::abs(larger.plane.signed_distance(surface.plane.project(surface.plane.anchor)));
  if (cosine > std::cos(max_angle_rad) && gap > nearest_m && gap < farthest_m &&
      width_shared_with(surface.evidence, larger.evidence) > most)
    return true;
  const double farthest = farthest_from(larger.plane, surface.evidence);
  return farthest > nearest_m && farthest < hung_m && larger_area > much_more * area &&
         width_within(surface.evidence, larger.evidence) > nearly_all;
}

namespace {

SurfaceRole role_of_upright(const SurfaceFacts& facts, const PlaneEvidence& evidence,
                            const Eigen::Vector3d& up, const PlaneRoleOptions& options) {
  const UprightShape shape = shape_of(evidence);
  if (shape.area_m2 < options.min_wall_area_m2) return SurfaceRole::undecided;
  if (shape.area_m2 < options.sure_wall_area_m2 && facts.observations <= options.min_observations)
    return SurfaceRole::undecided;
  const double above_ground =
      up.dot(evidence.frame().origin) - facts.ground_height_m.value_or(facts.camera_height_m - 1.4);
  const double high = above_ground + shape.high_m;
  const bool tall = high >= options.wall_top_m;
  if (shape.open_top_share > options.open_share && above_ground + shape.open_top_m < options.wall_top_m)
    return SurfaceRole::other;
  const bool open_side = std::max(shape.open_left, shape.open_right) > options.open_share;
  if (!tall && shape.width_m < options.leaf_width_m && open_side) return SurfaceRole::undecided;
  if (!tall && shape.high_m - shape.low_m < options.min_wall_height_m) return SurfaceRole::undecided;
  return SurfaceRole::wall;
}

SurfaceRole role_of_level(const SurfaceFacts& facts, const PlaneEvidence& evidence, const Eigen::Vector3d& up,
                          const PlaneRoleOptions& options) {
  if (facts.normal.dot(up) < 0) {
    return facts.height_m > facts.camera_height_m ? SurfaceRole::ceiling : SurfaceRole::other;
  }
  double area = 0;
  for (int t = evidence.cells().min_t(); t < evidence.cells().end_t(); ++t)
    for (int s = evidence.cells().min_s(); s < evidence.cells().end_s(); ++s)
      area += evidence.solid({s, t}) * cell_m * cell_m;
  constexpr double storey_area_m2 = 3.0;
  const bool raised = facts.lowest_level_m && facts.height_m > *facts.lowest_level_m + options.step_height_m;
  if (open_outline_share(evidence) > 0.5 * options.open_share) return SurfaceRole::other;
  if (area < options.min_ground_area_m2) return SurfaceRole::undecided;
  if (raised && area < storey_area_m2) return SurfaceRole::other;
  return SurfaceRole::ground;
}

}  // namespace

bool stance_allows(SurfaceRole role, const Eigen::Vector3d& normal, const Eigen::Vector3d& up,
                   double max_tilt_rad) {
  const double sine = normal.dot(up);
  const bool upright = std::abs(sine) < std::sin(max_tilt_rad);
  switch (role) {
    case SurfaceRole::wall:
    case SurfaceRole::door:
    case SurfaceRole::window:
      return upright;
    case SurfaceRole::ground:
      return sine > std::cos(max_tilt_rad);
    case SurfaceRole::ceiling:
      return sine < -std::cos(max_tilt_rad);
    case SurfaceRole::undecided:
    case SurfaceRole::other:
      return true;
  }
  return false;
}

SurfaceRole role_by_geometry(const SurfaceFacts& facts, const PlaneEvidence& evidence,
                             const Eigen::Vector3d& up, const PlaneRoleOptions& options) {
  if (facts.observations < options.min_observations) return SurfaceRole::undecided;
  if (stance_allows(SurfaceRole::wall, facts.normal, up, options.max_tilt_rad))
    return role_of_upright(facts, evidence, up, options);
  const bool level = std::abs(facts.normal.dot(up)) > std::cos(options.max_tilt_rad);
  return level ? role_of_level(facts, evidence, up, options) : SurfaceRole::other;
}

}  // namespace vsgraphs
