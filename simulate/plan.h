// A plan: what a person writes down to describe a synthetic place and a walk through it. Plain values; lengths in
// metres, angles in degrees (this is what plan files hold), world z up. docs/simulator.md explains every field.
// `build_scene` (scene.h) checks a plan and throws InputError naming the field, e.g. "rooms[1].polygon: ...".
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/polygon.h"

namespace vsgraphs {

// A ceiling that comes down towards a wall.
struct SlopePlan {
  int wall = 0;
  double knee = 1.2;   // its height at that wall
  double reach = 1.5;  // distance from the wall at which the room's full height is reached
};

struct RoomPlan {
  std::string id;
  std::string kind = "room";  // room | corridor | stairs
  Polygon2 polygon;           // inner faces of the walls, counter-clockwise
  double z_floor = 0;
  double height = 2.6;  // floor to ceiling
  int level = 0;        // storey
  bool counted = true;  // false: scenery, not scored
  bool skirting = true;
  std::string floor = "tiles";     // tiles | wood | carpet | terrazzo | concrete
  std::string ceiling = "panels";  // panels | plain
  Rgb wall_colour{205, 210, 200};
  double brightness = 1.0;  // of the room's lamps
  std::optional<std::vector<Eigen::Vector2d>>
      lamps;  // centres of ceiling lamps; absent: spread automatically
  std::optional<SlopePlan> slope;
};

struct DoorLeafPlan {
  std::string room;            // the room it opens into
  double angle_deg = 95;       // 0 closed, 90 square to the wall
  std::string hinge = "left";  // left | right, seen from that room
  double set_back = 0;         // of a leaf within its frame, behind the wall's face; 0: before the casing
  bool pair = false;           // two leaves of half the width
  std::vector<Eigen::Vector2d>
      turns;  // (time in s, angle in degrees): the leaf swings there from that time on
};

struct DoorPlan {
  std::vector<std::string> rooms;  // the two rooms it joins
  Eigen::Vector2d at{0, 0};        // middle of the opening, within 0.4 m of both rooms' walls
  double width = 0.95;
  double height = 2.05;
  std::optional<DoorLeafPlan> leaf;
};

struct WindowPlan {
  std::string room;
  int wall = 0;      // edge of the room's polygon, from vertex `wall` to the next
  double along = 1;  // centre, metres from that vertex
  double width = 1.4;
  double height = 1.3;
  double sill = 0.9;  // lower edge above the floor
  bool radiator = false;
  bool curtain = false;
  std::string view = "picture";  // picture: painted on the pane | parapet | street: built behind glass
  std::uint64_t seed = 0;
};

// Things that hang flat on a wall.
struct PosterPlan {
  std::string room;
  int wall = 0;
  double along = 1;  // centre, metres from vertex `wall`
  double z = 1.5;    // centre above the floor
  double width = 0.6;
  double height = 0.8;
  std::string kind = "poster";  // poster | picture | board | clock | notice | socket | switch | mirror
  std::uint64_t seed = 0;       // equal kinds, sizes and seeds look equal
};

// A square ArUco marker of the dictionary 4x4_50 on a white sheet, flat on a wall.
struct MarkerPlan {
  int id = 0;  // 0..49; the same number may hang twice
  std::string room;
  int wall = 0;
  double along = 1;    // centre, metres from vertex `wall`
  double z = 1.5;      // centre above the floor
  double size = 0.16;  // side of the black square; the sheet is wider by a sixth of it on each side
};

struct BoxPlan {
  std::string kind = "box";  // see furniture_kinds()
  std::string room;
  Eigen::Vector2d at{0, 0};             // centre of the footprint
  double z = 0;                         // lower face above the room's floor
  double yaw_deg = 0;                   // 0: its front looks along +y
  Eigen::Vector3d size{0.5, 0.5, 0.5};  // width (local x), depth (local y), height
  std::optional<Rgb> colour;
  std::uint64_t seed = 0;
};

// A thin wall that stands free in a room.
struct PartitionPlan {
  std::string room;
  Eigen::Vector2d from{0, 0}, to{0, 0};
  double height = 1.4, thickness = 0.06;
  std::string kind = "solid";  // solid | glass
  double mullions = 1.0;       // of glass: distance between its posts
};

// Somebody or something that moves while the camera looks on.
struct MoverPlan {
  std::string kind = "person";       // person | trolley
  std::string room;                  // whose floor it is on
  std::string pose = "walk";         // of a person: walk | stand | sit
  std::vector<Eigen::Vector2d> way;  // walked to and fro; a place for who stands or sits
  double speed = 1.0, start_s = 0, yaw_deg = 0;
  std::uint64_t seed = 0;
};

// The robot that carries the camera, as far as the camera sees it.
struct RobotPlan {
  double width = 0.4;
  double ahead = 0.3;  // how far its deck reaches in front of the camera
  double below = 0.1;  // how far the deck lies below it
};

// A straight flight of steps inside a room of kind "stairs".
struct StairsPlan {
  std::string room;
  Eigen::Vector2d from{0, 0}, to{0, 0};  // middle of the first riser and of the last one
  double width = 1.2;
  double rise = 2.6;
  int steps = 15;
  double landing = 0;  // length of the level stretch behind the last riser
};

struct WaypointPlan {
  Eigen::Vector2d at{0, 0};
  std::string room;                     // only needed where rooms lie above one another
  std::optional<double> z;              // camera height in the world; absent: floor + eye_height
  std::optional<Eigen::Vector2d> look;  // a point to look at, or ...
  std::optional<double> yaw_deg;        // ... a heading; neither: along the way
  std::optional<double> pitch_deg;      // up is positive; absent: the path's
  std::optional<double> look_z;         // with `look`: height looked at, instead of a pitch
  double pause_s = 0;
};

struct PathPlan {
  double eye_height = 1.35;
  double speed = 0.4;     // m/s
  double turn_rate = 28;  // deg/s, at most
  double pitch_deg = -6;
  double shake = 1;        // factor on the hand's and the steps' movement; 0: none
  double smooth_s = 0.45;  // time over which corners are rounded (standard deviation)
  double clearance = 0.2;  // free space around the camera
  bool closed = false;     // ends with the first way-point's pose again
  std::vector<WaypointPlan> waypoints;
  std::optional<RobotPlan> robot;
};

struct Plan {
  std::string name;
  std::string description;
  std::uint64_t seed = 1;
  double fps = 30;
  std::vector<RoomPlan> rooms;
  std::vector<DoorPlan> doors;
  std::vector<WindowPlan> windows;
  std::vector<PosterPlan> posters;
  std::vector<MarkerPlan> markers;
  std::vector<BoxPlan> boxes;
  std::vector<StairsPlan> stairs;
  std::vector<PartitionPlan> partitions;
  std::vector<MoverPlan> movers;
  PathPlan path;
};

}  // namespace vsgraphs
