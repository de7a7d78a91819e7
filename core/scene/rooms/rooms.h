// Rooms: free-space clusters bounded by walls that face them. vS-Graphs, section "Structural Element Recognition":
// proximity |n.v + d| <= omega, directionality n.(free space - wall) > 0, at least two walls, and a ground at right angles
// to them that lies between them. Beyond the paper: concave rooms, corridors, stable numbers.
#pragma once

#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/map/structure.h"
#include "core/scene/rooms/room_outline.h"

namespace vsgraphs {

struct RoomOptions {
  int min_walls = 2;
  double min_area_m2 = 1.5;
  double min_closed_share = 0.4;
  double min_solid_share = 0.8;
  double unvisited_closed_share = 0.7;
  double max_ground_tilt_deg = 11.5;
  double corridor_width_m = 2.4;
  double corridor_aspect = 2.5;
};

template <typename Visitor>
void describe(RoomOptions& o, Visitor& field) {
  field("min_walls", o.min_walls, 1, 10, "least number of walls that bound a room");
  field("min_area_m2", o.min_area_m2, 0.1, 20.0, "smallest area of a room, in square metres");
  field("min_closed_share", o.min_closed_share, 0.0, 1.0,
        "a room is partial if walls and openings close less than this share of its outline");
  field("min_solid_share", o.min_solid_share, 0.0, 1.0,
        "a room is partial if walls, openings and solid objects before it close less than this share of its "
        "outline");
  field("unvisited_closed_share", o.unvisited_closed_share, 0.0, 1.0,
        "an unvisited space is a room if this share of its outline is closed");
  field("max_ground_tilt_deg", o.max_ground_tilt_deg, 1.0, 30.0,
        "largest deviation from a right angle between a room's ground and its walls, in degrees");
  field("corridor_width_m", o.corridor_width_m, 0.5, 6.0, "greatest width of a corridor, in metres");
  field("corridor_aspect", o.corridor_aspect, 1.0, 20.0, "least ratio of length to width of a corridor");
}

// In the order of their clusters, not numbered yet.
struct RoomsOfLevel {
  std::vector<FoundRoom> rooms;
  std::vector<int> room_of_cluster;  // index into rooms; -1: the cluster is no room
};

RoomsOfLevel find_rooms(const LevelMap& map, const Clusters& clusters, std::span<const WallLine> walls,
                        const SceneFaces& faces, const RoomOptions& options,
                        const OutlineOptions& outline_options);

}  // namespace vsgraphs
