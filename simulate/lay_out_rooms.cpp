// Walls of every room and the holes that doors and windows cut into them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

constexpr double corner_margin_m = 0.05;  // wall left beside an opening
constexpr double door_reach_m = 0.4;      // how far a door's "at" may lie from either wall

void add_walls(SceneAssembly& builder) {
  Scene& scene = builder.scene();
  for (std::size_t r = 0; r < scene.plan.rooms.size(); ++r) {
    const RoomPlan& room = scene.plan.rooms[r];
    RoomGeometry geometry;
    for (std::size_t i = 0; i < room.polygon.size(); ++i) {
      WallGeometry wall;
      wall.room = static_cast<int>(r), wall.side = static_cast<int>(i);
      wall.p0 = room.polygon[i], wall.p1 = room.polygon[(i + 1) % room.polygon.size()];
      wall.length = (wall.p1 - wall.p0).norm();
      wall.along = (wall.p1 - wall.p0) / wall.length;
      wall.normal = {-wall.along.y(), wall.along.x()};
      wall.z_floor = room.z_floor, wall.height = room.height;
      geometry.walls.push_back(static_cast<int>(scene.walls.size()));
      scene.walls.push_back(wall);
    }
    scene.rooms.push_back(geometry);
  }
}

void cut(WallGeometry& wall, const Opening& hole, const std::string& key) {
  require_input(
      hole.along_min > corner_margin_m - 1e-9 && hole.along_max < wall.length - corner_margin_m + 1e-9,
      key + ": reaches beyond the ends of its wall (" + std::to_string(wall.length) +
          " m long); move it or make it narrower");
  require_input(hole.z_min >= -1e-9 && hole.z_max < wall.height,
                key + ": reaches above the ceiling or below the floor");
  for (const Opening& other : wall.openings) {
    const bool apart = hole.along_max < other.along_min || hole.along_min > other.along_max ||
                       hole.z_max < other.z_min || hole.z_min > other.z_max;
    require_input(apart, key + ": overlaps another door or window of the same wall");
  }
  wall.openings.push_back(hole);
}

// The pair of walls, one of each room, that face away from each other closest to the door.
std::array<int, 2> walls_of_door(const Scene& scene, const DoorPlan& door, std::array<int, 2> rooms,
                                 const std::string& key) {
  std::array<int, 2> best{-1, -1};
  double best_distance = std::numeric_limits<double>::infinity();
  for (const int a : scene.rooms[static_cast<std::size_t>(rooms[0])].walls) {
    for (const int b : scene.rooms[static_cast<std::size_t>(rooms[1])].walls) {
      const WallGeometry &wa = scene.walls[static_cast<std::size_t>(a)],
                         &wb = scene.walls[static_cast<std::size_t>(b)];
      if (wa.normal.dot(wb.normal) > -0.9999) continue;
      const double gap = wa.normal.dot(wa.p0 - wb.p0);  // positive: a wall's thickness between the rooms
      const double da = distance_to_segment(door.at, wa.p0, wa.p1),
                   db = distance_to_segment(door.at, wb.p0, wb.p1);
      if (gap < -1e-6 || gap > 2 * door_reach_m || std::max(da, db) > door_reach_m) continue;
      if (da + db < best_distance) best_distance = da + db, best = {a, b};
    }
  }
  require_input(best[0] >= 0, key + ".at: rooms \"" + door.rooms[0] + "\" and \"" + door.rooms[1] +
                                  "\" share no wall within " + std::to_string(door_reach_m) +
                                  " m of this point; doors stand between parallel walls");
  return best;
}

void add_door(SceneAssembly& builder, std::size_t index) {
  Scene& scene = builder.scene();
  const DoorPlan& plan = scene.plan.doors[index];
  const std::string key = "doors[" + std::to_string(index) + "]";
  DoorGeometry door;
  door.rooms = {builder.room_index(plan.rooms[0], key + ".rooms"),
                builder.room_index(plan.rooms[1], key + ".rooms")};
  door.walls = walls_of_door(scene, plan, door.rooms, key);
  WallGeometry& wa = scene.walls[static_cast<std::size_t>(door.walls[0])];
  WallGeometry& wb = scene.walls[static_cast<std::size_t>(door.walls[1])];
  door.z = std::max(wa.z_floor, wb.z_floor);
  door.width = plan.width, door.height = plan.height;
  door.normal = wa.normal;
  door.thickness = std::max(0.0, wa.normal.dot(wa.p0 - wb.p0));
  const double along_a = (plan.at - wa.p0).dot(wa.along);
  door.center = wa.p0 + along_a * wa.along - 0.5 * door.thickness * wa.normal;
  for (WallGeometry* wall : {&wa, &wb}) {
    const double along = (door.center - wall->p0).dot(wall->along);
    const double z = door.z - wall->z_floor;
    cut(*wall, {along - 0.5 * door.width, along + 0.5 * door.width, z, z + door.height}, key);
  }
  scene.doors.push_back(door);
}

void add_window(SceneAssembly& builder, std::size_t index) {
  Scene& scene = builder.scene();
  const WindowPlan& plan = scene.plan.windows[index];
  const std::string key = "windows[" + std::to_string(index) + "]";
  WindowGeometry window;
  window.room = builder.room_index(plan.room, key + ".room");
  const auto& walls = scene.rooms[static_cast<std::size_t>(window.room)].walls;
  require_input(plan.wall >= 0 && plan.wall < static_cast<int>(walls.size()),
                key + ".wall: room \"" + plan.room + "\" has walls 0.." + std::to_string(walls.size() - 1));
  WallGeometry& wall = scene.walls[static_cast<std::size_t>(walls[static_cast<std::size_t>(plan.wall)])];
  cut(wall,
      {plan.along - 0.5 * plan.width, plan.along + 0.5 * plan.width, plan.sill, plan.sill + plan.height},
      key);
  const Eigen::Vector2d center = wall.p0 + plan.along * wall.along;
  window.center = {center.x(), center.y(), wall.z_floor + plan.sill + 0.5 * plan.height};
  window.width = plan.width, window.height = plan.height;
  scene.windows.push_back(window);
}

}  // namespace

double WallGeometry::area() const {
  double area = length * height;
  for (const Opening& o : openings) area -= (o.along_max - o.along_min) * (o.z_max - o.z_min);
  return area;
}

void lay_out_rooms(SceneAssembly& builder) {
  add_walls(builder);
  for (std::size_t i = 0; i < builder.plan().doors.size(); ++i) add_door(builder, i);
  for (std::size_t i = 0; i < builder.plan().windows.size(); ++i) add_window(builder, i);
}

}  // namespace vsgraphs
