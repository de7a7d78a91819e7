#include "core/scene/rooms/clusters.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/scene/rooms/basins.h"
#include "core/scene/rooms/clearance.h"

namespace vsgraphs {
namespace {

constexpr double narrow_place_m = 0.3;  // how far the narrowest place may lie from the wall it is in

GridValues<char> open_cells(const LevelMap& map) {
  GridValues<char> open;
  open.reserve(map.cells.size());
  for (const CellState state : map.cells) open.push_back(state == CellState::open);
  return open;
}

// Cells of the group of closed cells around `start`, corners included; marks them in `seen`.
std::vector<int> closed_group(const GridFrame& frame, const GridValues<char>& open, int start,
                              std::vector<char>& seen) {
  std::vector<int> group{start};
  seen[static_cast<std::size_t>(start)] = 1;
  for (std::size_t i = 0; i < group.size(); ++i)
    for (const Eigen::Vector2i& step : grid_neighbours) {
      const Eigen::Vector2i next = frame.cell(group[i]) + step;
      if (!frame.inside(next)) continue;
      const auto index = static_cast<std::size_t>(frame.index(next));
      if (open[index] || seen[index]) continue;
      seen[index] = 1;
      group.push_back(frame.index(next));
    }
  return group;
}

// What stands free in a room (a lamp, a pillar, a screen on a desk, a patch nobody looked at) does not divide it. Walls
// do, wherever they stand.
void open_islands(const LevelMap& map, double max_island_m, GridValues<char>& open) {
  std::vector<char> seen(open.size(), 0);
  for (int start = 0; start < map.frame.size(); ++start) {
    if (open[static_cast<std::size_t>(start)] || seen[static_cast<std::size_t>(start)]) continue;
    const std::vector<int> group = closed_group(map.frame, open, start, seen);
    Eigen::Vector2i low = map.frame.cell(start), high = low;
    bool wall = false;
    for (const int cell : group) {
      low = low.cwiseMin(map.frame.cell(cell));
      high = high.cwiseMax(map.frame.cell(cell));
      wall = wall || map.walls[static_cast<std::size_t>(cell)];
    }
    const bool at_border =
        low.minCoeff() == 0 || high.x() == map.frame.width - 1 || high.y() == map.frame.height - 1;
    const double length = ((high - low).maxCoeff() + 1) * map.frame.cell_m;
    if (wall || at_border || length > max_island_m) continue;
    for (const int cell : group) open[static_cast<std::size_t>(cell)] = 1;
  }
}

void close_opening(const GridFrame& frame, const WallOpening& opening, GridValues<char>& open) {
  // Wide enough that no step between neighbouring cells leads across.
  const double half_band = 0.5 * opening.thickness_m + 0.6 * frame.cell_m;
  const double half_width = 0.5 * opening.width_m + 2 * frame.cell_m;
  const double radius = std::hypot(half_band, half_width) + frame.cell_m;
  const int reach = static_cast<int>(std::ceil(radius / frame.cell_m));
  const Eigen::Vector2i middle = frame.cell_at(opening.center);
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Eigen::Vector2i cell = middle + Eigen::Vector2i(dx, dy);
      if (!frame.inside(cell)) continue;
      const Eigen::Vector2d to = frame.center(frame.index(cell)) - opening.center;
      if (std::abs(to.dot(opening.normal)) <= half_band && std::abs(to.dot(opening.along())) <= half_width)
        open[static_cast<std::size_t>(frame.index(cell))] = 0;
    }
}

bool divides_rooms(const Narrowing& narrow, const LevelMap& map, std::span<const WallLine> walls,
                   const ClusterOptions& options, const OpeningOptions& openings) {
  if (narrow.gap.width_m > openings.max_width_m) return false;
  const OpeningEvidence evidence = opening_evidence(narrow.gap, map, walls, openings, narrow_place_m);
  if (evidence.sufficient()) return true;
  // Walls that were not made out yet: the shape of the free space has to do, and wall above the gap if walls are known
  // elsewhere.
  return evidence.lintel >= (walls.empty() ? 0 : 1) &&
         narrow.lower_peak_m >= options.narrowing * narrow.clearance_m;
}

// The label nearest to a camera: it does not see the column it stands in.
int label_near(const GridFrame& frame, const GridValues<int>& labels, const Eigen::Vector2d& camera) {
  constexpr int reach = 5;
  int best = -1, best_squared = reach * reach + 1;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Eigen::Vector2i cell = frame.cell_at(camera) + Eigen::Vector2i(dx, dy);
      if (!frame.inside(cell) || dx * dx + dy * dy >= best_squared) continue;
      const int label = labels[static_cast<std::size_t>(frame.index(cell))];
      if (label < 0) continue;
      best = label;
      best_squared = dx * dx + dy * dy;
    }
  return best;
}

// Measures the basins and keeps those large enough, in the order of their labels.
void keep_clusters(const GridFrame& frame, const Basins& basins, std::span<const Eigen::Vector2d> cameras,
                   double min_area_m2, Clusters& result) {
  std::vector<Cluster> all(static_cast<std::size_t>(basins.count));
  for (int i = 0; i < frame.size(); ++i) {
    const int label = basins.labels[static_cast<std::size_t>(i)];
    if (label < 0) continue;
    Cluster& cluster = all[static_cast<std::size_t>(label)];
    cluster.area_m2 += frame.cell_area_m2();
    cluster.centroid += frame.center(i) * frame.cell_area_m2();
    cluster.max_clearance_m =
        std::max<double>(cluster.max_clearance_m, result.clearance_m[static_cast<std::size_t>(i)]);
  }
  for (const Eigen::Vector2d& camera : cameras)
    if (const int label = label_near(frame, basins.labels, camera); label >= 0)
      all[static_cast<std::size_t>(label)].visited = true;
  std::vector<int> kept(all.size(), -1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].area_m2 < min_area_m2) continue;
    all[i].centroid /= all[i].area_m2;
    kept[i] = static_cast<int>(result.clusters.size());
    result.clusters.push_back(all[i]);
  }
  result.labels = basins.labels;
  for (int& label : result.labels)
    if (label >= 0) label = kept[static_cast<std::size_t>(label)];
}

// The cluster met first on the way from the opening, on one side.
int cluster_beside(const GridFrame& frame, const Clusters& clusters, const WallOpening& opening,
                   double side) {
  const double start = 0.5 * opening.thickness_m + frame.cell_m;
  for (double d = start; d <= start + 0.6; d += 0.5 * frame.cell_m)
    for (const double s : {0.0, 0.25, -0.25}) {
      const int index =
          frame.index_at(opening.center + side * d * opening.normal + s * opening.width_m * opening.along());
      if (index >= 0 && clusters.labels[static_cast<std::size_t>(index)] >= 0)
        return clusters.labels[static_cast<std::size_t>(index)];
    }
  return -1;
}

}  // namespace

Clusters find_clusters(const LevelMap& map, std::span<const WallLine> walls,
                       std::span<const Eigen::Vector2d> cameras, const ClusterOptions& options,
                       const OpeningOptions& opening_options) {
  GridValues<char> open = open_cells(map);
  open_islands(map, options.max_island_m, open);
  std::vector<WallOpening> openings = openings_in_walls(map, walls, opening_options);
  for (const WallOpening& opening : openings) close_opening(map.frame, opening, open);
  Clusters result;
  result.clearance_m = clearance_field(map.frame, open);
  const Basins basins = find_basins(
      map.frame, result.clearance_m, options.min_persistence_m,
      [&](const Narrowing& narrow) { return divides_rooms(narrow, map, walls, options, opening_options); });
  // Where wall is missing over a width nobody walks through, it divides all the same.
  std::copy_if(basins.openings.begin(), basins.openings.end(), std::back_inserter(openings),
               [&](const WallOpening& gap) { return gap.width_m >= opening_options.min_width_m; });
  keep_clusters(map.frame, basins, cameras, options.min_area_m2, result);
  for (const WallOpening& opening : openings) {
    const std::array<int, 2> sides{cluster_beside(map.frame, result, opening, -1),
                                   cluster_beside(map.frame, result, opening, 1)};
    if (sides[0] != sides[1]) result.openings.push_back({opening, sides});
  }
  return result;
}

}  // namespace vsgraphs
