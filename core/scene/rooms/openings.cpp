#include "core/scene/rooms/openings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace vsgraphs {
namespace {

constexpr double parallel_cosine = 0.94;  // 20 deg
constexpr double across_cosine = 0.5;
constexpr double own_line_m = 0.15;                             // pieces of one wall are in line this well
constexpr double stray_m = 0.15;                                // one closed cell does not end an opening
constexpr double through_front_m = 0.3, through_back_m = 0.45;  // both sides of an opening are free this far

CellState state_at(const LevelMap& map, const Eigen::Vector2d& point) {
  const int index = map.frame.index_at(point);
  return index < 0 ? CellState::unknown : map.cells[static_cast<std::size_t>(index)];
}

bool open_through(const LevelMap& map, const WallLine& wall, double coordinate) {
  const double step = 0.5 * map.frame.cell_m;
  const Eigen::Vector2d on_line = wall.point(coordinate);
  for (double d = -through_back_m; d <= through_front_m; d += step)
    if (state_at(map, on_line + d * wall.normal()) != CellState::open) return false;
  return true;
}

// Does `wall` go on in the line beyond `end`, in direction `out`?
bool continues_in_line(const WallLine& wall, const Eigen::Vector2d& end, const Eigen::Vector2d& out,
                       const OpeningOptions& options, double in_line_m) {
  if (std::abs(wall.along().dot(out)) < parallel_cosine) return false;
  if (std::abs(wall.distance(end)) > in_line_m) return false;
  const double sign = wall.along().dot(out) > 0 ? 1 : -1;
  const double t = wall.coordinate(end);
  const auto seen = [&](double near, double far) {
    return sign > 0 ? wall.seen_m(t + near, t + far, true) : wall.seen_m(t - far, t - near, true);
  };
  return seen(-0.1, options.jamb_m) >= 0.1 && seen(-0.1, options.jamb_m + 0.4) >= 0.2;
}

bool stands_across(const WallLine& wall, const Eigen::Vector2d& end, const Eigen::Vector2d& out,
                   const OpeningOptions& options, double) {
  if (std::abs(wall.along().dot(out)) > across_cosine) return false;
  const double beyond = -wall.distance(end) / wall.normal().dot(out);
  if (beyond < -0.15 || beyond > options.jamb_m) return false;
  const double t = wall.coordinate(end);
  return wall.seen_m(t - 0.3, t + 0.3, true) >= 0.2;
}

int lintel_evidence(const WallOpening& opening, const LevelMap& map) {
  int samples = 0, occupied = 0, free = 0;
  const double step = map.frame.cell_m;
  for (double s = -0.5 * opening.width_m; s <= 0.5 * opening.width_m; s += step) {
    ++samples;
    int best_occupied = 0, least_free = 255;
    // The gap's line is known to a cell or so: wall just before or behind it counts.
    for (double d = -0.5 * opening.thickness_m - step; d <= 0.5 * opening.thickness_m + step; d += step) {
      const int index = map.frame.index_at(opening.center + s * opening.along() + d * opening.normal);
      if (index < 0) continue;
      const ColumnCounts& c = map.columns[static_cast<std::size_t>(index)];
      best_occupied = std::max<int>(best_occupied, c.lintel_occupied);
      least_free = std::min<int>(least_free, c.lintel_free);
    }
    if (best_occupied >= 1) ++occupied;
    if (best_occupied == 0 && least_free >= 1 && least_free < 255) ++free;
  }
  if (2 * occupied >= samples) return 1;
  return 2 * free >= samples ? -1 : 0;
}

// The stretch between the first and last place one sees through.
std::optional<WallOpening> opening_between(const WallLine& wall, double from, double to,
                                           const OpeningOptions& options) {
  const double width = to - from;
  if (width < options.min_width_m || width > options.max_width_m) return std::nullopt;
  return WallOpening{wall.point(0.5 * (from + to)), wall.normal(), width, 0};
}

std::vector<WallOpening> openings_along(const LevelMap& map, const WallLine& wall,
                                        const OpeningOptions& options) {
  std::vector<WallOpening> openings;
  const double step = 0.5 * map.frame.cell_m;
  const double first = wall.from_m() - options.max_width_m, last = wall.to_m() + options.max_width_m;
  std::optional<std::pair<double, double>> run;  // first and last open place
  const auto close_run = [&] {
    // Runs that touch the end of the stretch looked at are wider than they seem.
    if (run && run->first > first && run->second + step <= last)
      if (const auto opening =
              opening_between(wall, run->first - 0.5 * step, run->second + 0.5 * step, options))
        openings.push_back(*opening);
    run.reset();
  };
  for (double t = first; t <= last; t += step) {
    if (open_through(map, wall, t))
      run = {run ? run->first : t, t};
    else if (run && t - run->second > stray_m)
      close_run();
  }
  close_run();
  return openings;
}

// A piece of the same face says the same again; the other face says how thick the wall is.
void unite(WallOpening& into, const WallOpening& other) {
  const bool other_face = into.normal.dot(other.normal) < 0;
  const double apart = into.normal.dot(other.center - into.center);
  const double aside = into.along().dot(other.center - into.center);
  if (other_face) into.thickness_m = std::max(into.thickness_m, std::abs(apart));
  into.center += 0.5 * (apart * into.normal + aside * into.along());
  into.width_m = std::max(into.width_m, other.width_m);
}

}  // namespace

OpeningEvidence opening_evidence(const WallOpening& opening, const LevelMap& map,
                                 std::span<const WallLine> walls, const OpeningOptions& options,
                                 double in_line_m) {
  OpeningEvidence evidence;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector2d out = side * opening.along();
    const Eigen::Vector2d end = opening.center + 0.5 * opening.width_m * out;
    const auto any = [&](auto&& test) {
      return std::any_of(walls.begin(), walls.end(),
                         [&](const WallLine& wall) { return test(wall, end, out, options, in_line_m); });
    };
    if (any(continues_in_line))
      ++evidence.in_line;
    else if (any(stands_across))
      ++evidence.across;
  }
  evidence.lintel = lintel_evidence(opening, map);
  return evidence;
}

bool same_opening(const WallOpening& a, const WallOpening& b, const OpeningOptions& options) {
  if (std::abs(a.normal.dot(b.normal)) < parallel_cosine) return false;
  const Eigen::Vector2d between = b.center - a.center;
  return std::abs(a.normal.dot(between)) <= options.max_thickness_m &&
         std::abs(a.along().dot(between)) <= 0.5 * std::max(a.width_m, b.width_m);
}

std::vector<WallOpening> openings_in_walls(const LevelMap& map, std::span<const WallLine> walls,
                                           const OpeningOptions& options) {
  std::vector<WallOpening> found;
  for (const WallLine& wall : walls)
    for (const WallOpening& opening : openings_along(map, wall, options)) {
      if (!opening_evidence(opening, map, walls, options, own_line_m).sufficient()) continue;
      const auto same = std::find_if(found.begin(), found.end(), [&](const WallOpening& known) {
        return same_opening(known, opening, options);
      });
      if (same == found.end())
        found.push_back(opening);
      else
        unite(*same, opening);
    }
  return found;
}

}  // namespace vsgraphs
