// Structural elements: rooms, doors, floors and places to be. Plain values in a levelled frame (z up, metres), found anew
// every few seconds from free space and planes; between two passes rooms' and floors' nodes are variables of the factor
// graph.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/geometry/polygon.h"
#include "core/geometry/se3.h"
#include "core/map/element.h"
#include "core/map/ids.h"

namespace vsgraphs {

// Names a room for as long as it is recognised again; never given to another one.
using RoomNumber = std::uint32_t;
inline constexpr RoomNumber no_room = 0xffffffffu;

enum class RoomKind : std::uint8_t { room, corridor };
template <>
inline constexpr std::size_t enum_size<RoomKind> = 2;

struct FoundRoom {
  RoomNumber number = no_room;
  std::vector<PlaneId> walls;  // faces that bound it, ascending; a face may bound several rooms
  PlaneId ground, ceiling;     // not valid: not known
  Polygon2 polygon;            // counter-clockwise, on the walls' inner faces
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // of the polygon, on the ground
  double ground_m = 0;
  double area_m2 = 0;
  std::optional<double> height_m;  // ground to ceiling, where a ceiling was seen
  RoomKind kind = RoomKind::room;
  double closed_share = 0;             // of the outline: by wall that was seen, or by an opening
  bool partial = false;                // too little of the outline is closed to trust its shape
  bool visited = false;                // the camera has been inside
  std::vector<RoomNumber> neighbours;  // through openings, ascending
};
template <FieldsOf<FoundRoom> T>
void visit_fields(T& v, auto& field) {
  auto& [number, walls, ground, ceiling, polygon, centroid, ground_m, area_m2, height_m, kind, closed_share,
         partial, visited, neighbours] = v;
  field(number, walls, ground, ceiling, polygon, centroid, ground_m, area_m2, height_m, kind, closed_share,
        partial, visited, neighbours);
}

struct FoundDoor {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // middle of the threshold, on the ground
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();   // unit, horizontal, from rooms[0] to rooms[1]
  double width_m = 0;
  std::optional<double> height_m;  // where rays passed below its upper edge
  double thickness_m = 0;          // of the wall; 0: only one face is known
  std::array<RoomNumber, 2> rooms{no_room, no_room};
};
template <FieldsOf<FoundDoor> T>
void visit_fields(T& v, auto& field) {
  auto& [position, normal, width_m, height_m, thickness_m, rooms] = v;
  field(position, normal, width_m, height_m, thickness_m, rooms);
}

struct FoundFloor {
  double ground_m = 0;
  std::vector<RoomNumber> rooms;                       // ascending
  std::vector<PlaneId> grounds;                        // ascending: coplanar within tolerance
  std::vector<Polygon2> extent;                        // of its rooms; they do not overlap
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // mean of its rooms' centroids
};
template <FieldsOf<FoundFloor> T>
void visit_fields(T& v, auto& field) {
  auto& [ground_m, rooms, grounds, extent, centroid] = v;
  field(ground_m, rooms, grounds, extent, centroid);
}

// A place to be: a point with free space around it. Edges lead over free ground.
struct Place {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // at the height of the ground
  double clearance_m = 0;
  RoomNumber room = no_room;              // no_room: in a doorway or outside all rooms
  std::vector<std::uint32_t> neighbours;  // indices, ascending
};
template <FieldsOf<Place> T>
void visit_fields(T& v, auto& field) {
  auto& [position, clearance_m, room, neighbours] = v;
  field(position, clearance_m, room, neighbours);
}

struct FoundStructure {
  bool sought = false;           // false: nobody has looked for rooms yet
  std::vector<FoundRoom> rooms;  // by storey, ascending
  std::vector<FoundDoor> doors;
  std::vector<FoundFloor> floors;
  std::vector<Place> places;
  RoomNumber next_number = 0;  // the first number never given to a room
  Se3 level_from_world;
  // Where the vertices of the factor graph stand, world: of each room, of each floor. A room's is the mean of its walls'
  // centroids (the paper's room centroid), which furniture may pull off the middle of its polygon.
  std::vector<Eigen::Vector3d> room_nodes, floor_nodes;
  std::vector<std::string> element_kinds;  // that were sought; of others nothing is known
  std::vector<FoundElement> elements;      // by kind
  ElementNumber next_element = 0;          // the first number never given to an element
};
template <FieldsOf<FoundStructure> T>
void visit_fields(T& v, auto& field) {
  auto& [sought, rooms, doors, floors, places, next_number, level_from_world, room_nodes, floor_nodes,
         element_kinds, elements, next_element] = v;
  field(sought, rooms, doors, floors, places, next_number, level_from_world, room_nodes, floor_nodes);
  field.since(4, element_kinds, elements, next_element);
}

}  // namespace vsgraphs
