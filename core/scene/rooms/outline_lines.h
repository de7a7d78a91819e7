// The lines an outline of a room may follow: of the walls that face its free space, of its openings, and where free space
// ends on a side on which no wall was seen.
#pragma once

#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/scene/rooms/arrangement.h"
#include "core/scene/rooms/clusters.h"
#include "core/scene/rooms/wall_line.h"

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
  field("proximity_m", o.proximity_m, 0.2, 3.0,
        "largest distance from a wall to the free space that it bounds, in metres");
  field("min_wall_m", o.min_wall_m, 0.1, 2.0,
        "least length along which a wall must bound free space, in metres");
  field("same_line_m", o.same_line_m, 0.01, 0.5,
        "largest offset between walls of a room that are put on one line, in metres");
  field("same_line_deg", o.same_line_deg, 0.5, 20.0,
        "largest angle between walls of a room that are put on one line, in degrees");
  field("unknown_cost", o.unknown_cost, 0.0, 1.0,
        "cost of one square metre of unseen space inside a room; free space left outside costs 1 per square "
        "metre");
  field("unseen_edge_cost", o.unseen_edge_cost, 0.0, 2.0,
        "cost of one metre of a room's outline where no wall was seen");
}

// Walls near which the cluster has free space on the side they face: proximity and directionality, tested piece by piece
// so that they hold for concave rooms too.
std::vector<std::size_t> walls_around(int cluster, const LevelMap& map, const Clusters& clusters,
                                      std::span<const WallLine> walls, const OutlineOptions& options);

// At most Arrangement::max_lines; walls in one line give one.
std::vector<PlanLine> outline_lines(int cluster, const LevelMap& map, const Clusters& clusters,
                                    std::span<const WallLine> walls, std::span<const std::size_t> nearby,
                                    const OutlineOptions& options);

// Centres of a cluster's cells.
std::vector<Eigen::Vector2d> cells_of(int cluster, const LevelMap& map, const Clusters& clusters);

}  // namespace vsgraphs
