// Openings in walls: where one sees through the line of a wall between two pieces of it. They are the places where free
// space is cut into rooms.
#pragma once

#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/scene/rooms/level_map.h"
#include "core/scene/rooms/wall_line.h"

namespace vsgraphs {

struct OpeningOptions {
  double min_width_m = 0.4;
  double max_width_m = 1.6;
  double max_thickness_m = 0.5;
  double jamb_m = 0.35;
};

template <typename Visitor>
void describe(OpeningOptions& o, Visitor& field) {
  field("min_width_m", o.min_width_m, 0.1, 1.0,
        "narrowest gap in a wall that is an opening, in metres; a narrower one is a crack");
  field("max_width_m", o.max_width_m, 0.6, 4.0,
        "widest gap in a wall that is an opening, in metres; a wider one joins two parts of one room");
  field("max_thickness_m", o.max_thickness_m, 0.05, 1.0,
        "largest thickness of a wall whose two faces are paired, in metres");
  field("jamb_m", o.jamb_m, 0.1, 1.0,
        "an opening ends at a piece of wall that is no farther away than this, in metres");
}

struct WallOpening {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();   // half-way through the wall
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // unit, across the threshold
  double width_m = 0;
  double thickness_m = 0;  // between the wall's faces; 0: only one is known

  Eigen::Vector2d along() const { return {-normal.y(), normal.x()}; }
};

// What speaks for a gap being an opening in a wall.
struct OpeningEvidence {
  int in_line = 0;  // ends (0-2) at which a wall goes on in the gap's own line
  int across = 0;   // further ends at a wall that stands across it: a door in a corner
  int lintel = 0;   // 1: there is wall above the gap; -1: there is free space; 0: not known

  bool sufficient() const { return in_line + across + lintel >= 2 && (in_line > 0 || lintel > 0); }
};

// `in_line_m`: how well the gap's line is known.
OpeningEvidence opening_evidence(const WallOpening& opening, const LevelMap& map,
                                 std::span<const WallLine> walls, const OpeningOptions& options,
                                 double in_line_m);

// Openings in known walls; the two faces of a wall give one.
std::vector<WallOpening> openings_in_walls(const LevelMap& map, std::span<const WallLine> walls,
                                           const OpeningOptions& options);

// True if `a` and `b` are the same gap.
bool same_opening(const WallOpening& a, const WallOpening& b, const OpeningOptions& options);

}  // namespace vsgraphs
