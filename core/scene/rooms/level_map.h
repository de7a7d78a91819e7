// One storey seen from above: what is known of each column of the free-space grid over a ground.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/scene/rooms/grid.h"
#include "core/scene/rooms/surfaces.h"
#include "core/scene/space/free_space.h"

namespace vsgraphs {

struct LevelOptions {
  double band_low_m = 0.3;
  double furniture_m = 1.2;
  double band_high_m = 2.0;
  double lintel_low_m = 2.1;
  double lintel_high_m = 2.35;
  double wall_high_m = 2.6;
  double min_ground_area_m2 = 1.0;
  double min_storey_m = 1.8;
};

template <typename Visitor>
void describe(LevelOptions& o, Visitor& field) {
  field("band_low_m", o.band_low_m, 0.1, 1.0,
        "height above the ground at which the free band begins, in metres");
  field("furniture_m", o.furniture_m, 0.3, 1.8,
        "height above the ground, in metres, below which objects are furniture and do not bound a room");
  field("band_high_m", o.band_high_m, 1.3, 2.5,
        "height above the ground at which the free band ends, in metres");
  field("lintel_low_m", o.lintel_low_m, 1.8, 3.0,
        "lowest height above the ground at which wall above a door is sought, in metres");
  field("lintel_high_m", o.lintel_high_m, 1.9, 4.0,
        "greatest height above the ground at which wall above a door is sought, in metres");
  field("wall_high_m", o.wall_high_m, 1.5, 6.0,
        "points of walls higher above the ground than this, in metres, do not count for a storey");
  field("min_ground_area_m2", o.min_ground_area_m2, 0.1, 20.0,
        "smallest ground of a storey, in square metres");
  field("min_storey_m", o.min_storey_m, 0.5, 5.0,
        "grounds closer above each other than this, in metres, belong to one storey");
}

// Wall seen below this height above the ground is in the way of a person. A wall's points stand for cells of 0.1 m: one
// near the top of the free band may be the lower edge of the lintel of a door (1.98 m and more).
inline double head_m(const LevelOptions& options) { return options.band_high_m - 0.1; }

// Heights of the storeys, ascending. A table top or a landing taken for ground does not make a storey: it is too close to
// a larger one.
std::vector<double> level_heights(std::span<const SceneFace> grounds, const LevelOptions& options);

// Voxels of one column, counted by height above the ground.
struct ColumnCounts {
  std::uint8_t low_free = 0, low_occupied = 0;    // free band below furniture_m
  std::uint8_t high_free = 0, high_occupied = 0;  // free band above it
  std::uint8_t lintel_free = 0, lintel_occupied = 0;
  std::uint8_t below_free = 0, ground_occupied = 0;  // under the ground; at its height
};

enum class CellState : std::uint8_t { unknown, open, blocked };

struct LevelMap {
  double ground_m = 0;
  GridFrame frame;
  GridValues<ColumnCounts> columns;
  // open: one can see through at eye level, whatever stands below (tables, chairs); blocked: something is there, or there is
  // no ground (a stairwell).
  GridValues<CellState> cells;
  GridValues<char> walls;  // 1: a wall's points lie here, between the free band's lower end and head_m()
};

// Walls' points between band_low_m and head_m() block their cells too. Linear in the grid's blocks.
LevelMap build_level_map(const VoxelBlocks& voxels, double voxel_m, double ground_m,
                         std::span<const SceneFace> walls, const LevelOptions& options);

}  // namespace vsgraphs
