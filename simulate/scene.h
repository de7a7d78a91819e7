// A plan turned into surfaces to look at, things to bump into and the truth to score against. World: z up, metres.
// A scene owns everything it needs and does not change once built; it may be shared by renderers.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/se3.h"
#include "simulate/camera_path.h"
#include "simulate/materials.h"
#include "simulate/motion.h"
#include "simulate/plan.h"

namespace vsgraphs {

// Values of the class images; the order is the file format.
enum class SceneClass : std::uint8_t {
  none,
  wall,
  floor,
  ceiling,
  door,
  window,
  table,
  chair,
  sofa,
  bed,
  cabinet,
  picture,
  curtain,
  plant,
  lamp,
  rug,
  misc,
  screen,
  radiator,
  stairs,
  mirror,
  glass,
  person,
  pillar,
  robot
};
inline constexpr std::array<std::string_view, 25> scene_class_names{
    "void",     "wall",    "floor",   "ceiling", "door",   "window", "table", "chair", "sofa",
    "bed",      "cabinet", "picture", "curtain", "plant",  "lamp",   "rug",   "misc",  "screen",
    "radiator", "stairs",  "mirror",  "glass",   "person", "pillar", "robot"};
// Those every truth file names, whether they occur or not.
inline constexpr std::size_t first_rare_class = 20;

// What light does at a surface.
enum class Optics : std::uint8_t { matt, mirror, glass };

// Light falling on a face, on a grid over its bounding rectangle; blended bilinearly. 1 = the nominal brightness.
struct Lightmap {
  int width = 1, height = 1;
  float nodes_per_s = 0, nodes_per_t = 0;  // grid steps per metre
  std::vector<float> light{1.0f};
};

// A flat surface seen from one side. Points: origin + s * s_axis + t * t_axis, (s, t) in metres.
struct Face {
  Eigen::Vector3d origin, s_axis, t_axis;  // the axes are orthonormal
  std::vector<Polygon2>
      contours;          // in (s, t), s and t >= 0; covered by the even-odd rule, so holes are contours too
  Eigen::Vector2d size;  // of the bounding rectangle from (0, 0)
  int material = 0;
  Eigen::Vector2d repeats_per_m{1, 1};   // texture repeats per metre of s and t
  Eigen::Vector2d texture_offset{0, 0};  // repeats
  float emission = 0;                    // > 0: shines by itself, not lit by the room
  SceneClass label = SceneClass::none;
  std::uint16_t instance = 0;
  int room = -1;  // hidden when this room cannot be seen; -1: never hidden
  Optics optics = Optics::matt;
  int mover = -1;  // >= 0: the face is given in that mover's frame and goes with it
  Lightmap lightmap;

  Eigen::Vector3d normal() const { return s_axis.cross(t_axis); }
};

struct
    Instance {  // what one value of the instance images stands for; the index in Scene::instances is the value
  SceneClass label = SceneClass::none;
  std::string room, kind;  // empty where it does not apply
  int side = -1, door = -1;
};

struct Opening {  // a hole in a wall, (along, height) relative to the wall's p0 and its room's floor
  double along_min, along_max, z_min, z_max;
};

struct WallGeometry {
  int room = 0, side = 0;
  Eigen::Vector2d p0, p1;  // counter-clockwise along the room
  Eigen::Vector2d along;   // unit, p0 to p1
  Eigen::Vector2d normal;  // unit, into the room
  double length = 0, z_floor = 0, height = 0;
  std::uint16_t instance = 0;
  std::vector<Opening> openings;
  double area() const;  // without the openings
};

struct RoomGeometry {
  std::vector<int> walls;
  std::uint16_t floor_instance = 0, ceiling_instance = 0;
};

struct DoorGeometry {
  std::array<int, 2> rooms{}, walls{};
  Eigen::Vector2d center;  // middle of the passage, half-way through the wall
  Eigen::Vector2d normal;  // of the first room's wall, into the first room
  double thickness = 0;    // of the wall between
  double z = 0, width = 0, height = 0;
  std::uint16_t instance = 0, leaf_instance = 0, second_leaf_instance = 0;
};

struct WindowGeometry {
  int room = 0;
  Eigen::Vector3d center;
  double width = 0, height = 0;
  std::uint16_t instance = 0;
};

struct PartitionGeometry {
  int room = 0;
  Eigen::Vector3d from, to;  // on the floor
  std::uint16_t instance = 0;
};

struct MirrorGeometry {
  int room = 0;
  Eigen::Vector3d center, normal;
  double width = 0, height = 0;
  std::uint16_t instance = 0;
};

struct MarkerGeometry {
  int room = 0;
  Se3 world_from_marker;  // origin in the middle of the print; x to the right of who reads it, y up, z out of the wall
  std::uint16_t instance = 0;
};

// Something solid the camera must not enter: a box turned about the vertical.
struct Solid {
  Eigen::Vector2d center, half;
  double yaw_rad = 0, z_min = 0, z_max = 0;
  std::string name;    // for messages, e.g. "boxes[3] (bookshelf)"
  double shading = 1;  // how much light it takes from what is near, against a wall
};

struct Light {
  Eigen::Vector3d position, direction;  // direction: where it shines, unit
  double power = 1;
  int room = 0;
};

struct Scene {
  Plan plan;
  std::vector<Face> faces;
  std::vector<int> mirrors, panes;  // faces with these optics
  std::vector<Mover> movers;
  std::vector<Walk> walks;
  std::vector<MaterialStore::Entry> materials;
  std::vector<Instance> instances;
  std::vector<RoomGeometry> rooms;  // in the plan's order, as are doors, windows and markers
  std::vector<WallGeometry> walls;
  std::vector<DoorGeometry> doors;
  std::vector<WindowGeometry> windows;
  std::vector<MarkerGeometry> markers;
  std::vector<PartitionGeometry> partitions;
  std::vector<MirrorGeometry> wall_mirrors;
  std::vector<std::uint16_t> moving;  // instances of the plan's movers, in its order
  std::vector<Solid> solids;
  std::vector<Light> lights;
  CameraPath path;

  int frame_count() const { return path.frame_count(plan.fps); }
  // Takes a mover's own coordinates to the world at a time; the identity for mover -1.
  Se3 world_from_mover(int mover, double time_s) const;
};

// Throws InputError naming the plan's field when the plan cannot be built or walked. Deterministic. Takes well under a
// second for a few rooms.
Scene build_scene(const Plan& plan);

// Names a plan may use, for checks and suggestions.
std::vector<std::string> furniture_kinds();
std::vector<std::string> poster_kinds();
std::vector<std::string> floor_kinds();

}  // namespace vsgraphs
