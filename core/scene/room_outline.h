// The outline of a room: walls' lines divide the plan into faces, and the cheapest set of faces that holds the cluster's
// free space and is bounded by wall where wall was seen is the room. So furniture before a wall or across a corner does not
// dent it, and rooms may have any number of walls in any direction, concave ones included.
// In the spirit of Ochmann et al., "Automatic reconstruction of parametric building models from indoor point clouds",
// Computers & Graphics 2016 (line arrangement and energy minimisation); here one room at a time, exactly, by minimum cut.
#pragma once

#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/scene/arrangement.h"
#include "core/scene/clusters.h"
#include "core/scene/wall_line.h"

namespace vsgraphs {

struct OutlineOptions {
  double proximity_m = 1.0;
  double min_wall_m = 0.3;
  double same_line_m = 0.12;
  double same_line_deg = 8.0;
  double unknown_cost = 0.2;
  double unseen_edge_cost = 0.35;
};

template <typename Visitor>
void describe(OutlineOptions& o, Visitor& field) {
  field("proximity_m", o.proximity_m, 0.2, 3.0, "a wall bounds free space no farther from it than this");
  field("min_wall_m", o.min_wall_m, 0.1, 2.0, "... along at least this much of its length");
  field("same_line_m", o.same_line_m, 0.01, 0.5, "walls of a room in one line up to this shift share it");
  field("same_line_deg", o.same_line_deg, 0.5, 20.0, "... and up to this turn");
  field("unknown_cost", o.unknown_cost, 0.0, 1.0,
        "price of a square metre nobody saw inside a room; one of free space left outside costs 1");
  field("unseen_edge_cost", o.unseen_edge_cost, 0.0, 2.0,
        "price of a metre of outline where no wall was seen");
}

struct RoomOutline {
  std::vector<OutlineEdge> edges;  // closed, inside to the left; empty: no outline found
  std::vector<std::size_t> walls;  // indices of the wall lines that bound it, ascending
  double perimeter_m = 0;
  double closed_m = 0;  // by wall that was seen, or by an opening
  double solid_m = 0;   // closed, or something solid stands there or before it: furniture hides walls
  Polygon2 polygon() const;
};

// Walls near which the cluster has free space on the side they face: proximity and directionality, tested piece by piece
// so that they hold for concave rooms too.
std::vector<std::size_t> walls_around(int cluster, const LevelMap& map, const Clusters& clusters,
                                      std::span<const WallLine> walls, const OutlineOptions& options);

// `nearby`: what walls_around() gave.
RoomOutline outline_room(int cluster, const LevelMap& map, const Clusters& clusters,
                         std::span<const WallLine> walls, std::span<const std::size_t> nearby,
                         const OutlineOptions& options);

}  // namespace vsgraphs
