#include "core/scene/rooms/level_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vsgraphs {
namespace {

constexpr double at_ground_m = 0.2, below_m = 0.8;  // layers in which a ground is, or is missing

// Area a face covers seen from above, counted on a coarse raster: points are thinned, so they cannot just be counted.
double covered_area_m2(const SceneFace& face) {
  constexpr double raster_m = 0.2;
  std::vector<std::pair<int, int>> cells;
  for (const Eigen::Vector3f& p : face.points)
    cells.emplace_back(static_cast<int>(std::floor(p.x() / raster_m)),
                       static_cast<int>(std::floor(p.y() / raster_m)));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return raster_m * raster_m * static_cast<double>(cells.size());
}

double mean_height(const SceneFace& face) {
  double sum = 0;
  for (const Eigen::Vector3f& p : face.points) sum += p.z();
  return sum / static_cast<double>(face.points.size());
}

// A range of voxel layers [first, end).
struct Layers {
  int first, end;
  bool contain(int z) const { return z >= first && z < end; }
};

Layers layers_between(double low_m, double high_m, double voxel_m) {
  return {static_cast<int>(std::lround(low_m / voxel_m)), static_cast<int>(std::lround(high_m / voxel_m))};
}

struct Bands {
  Layers low, high, lintel, ground, below;
};

// Smallest frame around all blocks that reach into the free band, with a margin of one cell. None where they lie so far apart
// that most of it would be empty, as in a map that a wrong loop has torn: its rooms are not to be had for any memory.
GridFrame frame_of(const VoxelBlocks& voxels, double voxel_m, const Bands& bands) {
  constexpr std::int64_t most_cells = 1 << 24;  // 400 m x 400 m at 0.1 m
  Eigen::Vector2i low = Eigen::Vector2i::Constant(1 << 28), high = -low;
  for (const VoxelBlocks::Block& block : voxels.blocks()) {
    if (block.origin.z() + VoxelBlocks::edge <= bands.low.first || block.origin.z() >= bands.high.end)
      continue;
    low = low.cwiseMin(block.origin.head<2>());
    high = high.cwiseMax(block.origin.head<2>() + Eigen::Vector2i::Constant(VoxelBlocks::edge));
  }
  if (low.x() >= high.x()) return {{0, 0}, voxel_m, 0, 0};
  const Eigen::Vector2i size = high - low + Eigen::Vector2i::Constant(2);
  if (std::int64_t{size.x()} * size.y() > most_cells) return {{0, 0}, voxel_m, 0, 0};
  return {low - Eigen::Vector2i::Ones(), voxel_m, size.x(), size.y()};
}

void count_block(const VoxelBlocks::Block& block, const Bands& bands, LevelMap& map) {
  constexpr int edge = VoxelBlocks::edge;
  for (int z = 0; z < edge; ++z) {
    const int layer = block.origin.z() + z;
    const bool low = bands.low.contain(layer), high = bands.high.contain(layer),
               lintel = bands.lintel.contain(layer), ground = bands.ground.contain(layer),
               below = bands.below.contain(layer);
    if (!low && !high && !lintel && !ground && !below) continue;
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x) {
        const Voxel& voxel = block.at(x, y, z);
        const bool occupied = voxel.occupied();
        if (!occupied && !voxel.free()) continue;
        const Eigen::Vector2i cell = block.origin.head<2>() + Eigen::Vector2i(x, y) - map.frame.origin;
        if (!map.frame.inside(cell)) continue;
        ColumnCounts& c = map.columns[static_cast<std::size_t>(map.frame.index(cell))];
        if (low) ++(occupied ? c.low_occupied : c.low_free);
        if (high) ++(occupied ? c.high_occupied : c.high_free);
        if (lintel) ++(occupied ? c.lintel_occupied : c.lintel_free);
        if (ground && occupied) ++c.ground_occupied;
        if (below && !occupied) ++c.below_free;
      }
  }
}

CellState state_of(const ColumnCounts& c) {
  if (c.below_free >= 3 && c.ground_occupied == 0) return CellState::blocked;
  if (c.high_occupied >= 2 || (c.high_occupied == 1 && c.high_free < 3)) return CellState::blocked;
  if (c.high_free >= 2) return CellState::open;
  // Seen only below eye level (a camera that looks down).
  if (c.low_occupied == 0 && c.low_free >= 4) return CellState::open;
  return c.low_occupied > 0 ? CellState::blocked : CellState::unknown;
}

void block_walls(std::span<const SceneFace> walls, const LevelOptions& options, LevelMap& map) {
  for (const SceneFace& wall : walls)
    for (const Eigen::Vector3f& p : wall.points) {
      const double above = p.z() - map.ground_m;
      if (above < options.band_low_m || above > head_m(options)) continue;
      const int index = map.frame.index_at(p.head<2>().cast<double>());
      if (index < 0) continue;
      map.cells[static_cast<std::size_t>(index)] = CellState::blocked;
      map.walls[static_cast<std::size_t>(index)] = 1;
    }
}

}  // namespace

std::vector<double> level_heights(std::span<const SceneFace> grounds, const LevelOptions& options) {
  std::vector<std::pair<double, double>> by_area;  // (-area, height)
  for (const SceneFace& face : grounds)
    if (const double area = covered_area_m2(face); area >= options.min_ground_area_m2)
      by_area.emplace_back(-area, mean_height(face));
  std::sort(by_area.begin(), by_area.end());
  std::vector<double> levels;
  for (const auto& [area, height] : by_area)
    if (std::none_of(levels.begin(), levels.end(),
                     [&, z = height](double level) { return std::abs(level - z) < options.min_storey_m; }))
      levels.push_back(height);
  std::sort(levels.begin(), levels.end());
  return levels;
}

LevelMap build_level_map(const VoxelBlocks& voxels, double voxel_m, double ground_m,
                         std::span<const SceneFace> walls, const LevelOptions& options) {
  const Bands bands{
      layers_between(ground_m + options.band_low_m, ground_m + options.furniture_m, voxel_m),
      layers_between(ground_m + options.furniture_m, ground_m + options.band_high_m, voxel_m),
      layers_between(ground_m + options.lintel_low_m, ground_m + options.lintel_high_m, voxel_m),
      layers_between(ground_m - at_ground_m, ground_m + at_ground_m, voxel_m),
      layers_between(ground_m - below_m, ground_m - at_ground_m, voxel_m)};
  LevelMap map;
  map.ground_m = ground_m;
  map.frame = frame_of(voxels, voxel_m, bands);
  map.columns.resize(static_cast<std::size_t>(map.frame.size()));
  for (const VoxelBlocks::Block& block : voxels.blocks()) count_block(block, bands, map);
  map.cells.reserve(map.columns.size());
  for (const ColumnCounts& c : map.columns) map.cells.push_back(state_of(c));
  map.walls.assign(map.columns.size(), 0);
  block_walls(walls, options, map);
  return map;
}

}  // namespace vsgraphs
