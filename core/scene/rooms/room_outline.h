// The outline of a room: walls' lines divide the plan into faces, and the cheapest set of faces that holds the cluster's
// free space and is bounded by wall where wall was seen is the room. So furniture before a wall or across a corner does not
// dent it, and rooms may have any number of walls in any direction, concave ones included.
// In the spirit of Ochmann et al., "Automatic reconstruction of parametric building models from indoor point clouds",
// Computers & Graphics 2016 (line arrangement and energy minimisation); here one room at a time, exactly, by minimum cut.
#pragma once

#include <span>
#include <vector>

#include "core/scene/rooms/arrangement.h"
#include "core/scene/rooms/clusters.h"
#include "core/scene/rooms/outline_lines.h"
#include "core/scene/rooms/wall_line.h"

namespace vsgraphs {

struct RoomOutline {
  std::vector<OutlineEdge> edges;  // closed, inside to the left; empty: no outline found
  std::vector<std::size_t> walls;  // indices of the wall lines that bound it, ascending
  double perimeter_m = 0;
  double closed_m = 0;  // by wall that was seen, or by an opening
  double solid_m = 0;   // closed, or something solid stands there or before it: furniture hides walls
  Polygon2 polygon() const;
};

// `nearby`: what walls_around() gave.
RoomOutline outline_room(int cluster, const LevelMap& map, const Clusters& clusters,
                         std::span<const WallLine> walls, std::span<const std::size_t> nearby,
                         const OutlineOptions& options);

}  // namespace vsgraphs
