// From a plan's way-points to a path that has been checked to stay in free space.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "core/base/check.h"
#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double check_step_s = 0.05;
constexpr double door_clearance_m = 0.12;  // to the jambs; doorways are narrower than rooms

std::string waypoint(std::size_t i) { return "path.waypoints[" + std::to_string(i) + "]"; }

std::string place(const Eigen::Vector3d& p) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "(%.2f, %.2f, %.2f)", p.x(), p.y(), p.z());
  return text.data();
}

int room_of(const Scene& scene, std::size_t i, int previous) {
  const WaypointPlan& w = scene.plan.path.waypoints[i];
  std::vector<int> found;
  for (std::size_t r = 0; r < scene.plan.rooms.size(); ++r) {
    const RoomPlan& room = scene.plan.rooms[r];
    if (!w.room.empty() && room.id != w.room) continue;
    if (contains(room.polygon, w.at)) found.push_back(static_cast<int>(r));
  }
  if (found.size() > 1 && std::find(found.begin(), found.end(), previous) != found.end()) return previous;
  require_input(found.size() <= 1, waypoint(i) + ": lies in several rooms above one another; add \"room\"");
  return found.empty() ? -1 : found.front();
}

// The floor of a doorway around a point between two rooms.
std::optional<double> doorway_ground(const Scene& scene, const Eigen::Vector2d& at) {
  for (const DoorGeometry& door : scene.doors)
    if ((at - door.center).norm() < 0.5 * (door.width + door.thickness)) return door.z;
  return std::nullopt;
}

std::vector<ViewPoint> view_points(const Scene& scene) {
  const PathPlan& path = scene.plan.path;
  std::vector<ViewPoint> points;
  int room = -1;
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const WaypointPlan& w = path.waypoints[i];
    ViewPoint point;
    const int here = room_of(scene, i, room);
    double ground = 0;
    if (here >= 0) {
      room = here;
      ground = ground_height(scene.plan, here, w.at);
    } else {
      const auto doorway = doorway_ground(scene, w.at);
      require_input(doorway.has_value() || w.z,
                    waypoint(i) + ".at: lies in no room and no doorway" +
                        (w.room.empty() ? std::string() : " (room \"" + w.room + "\" is asked for)"));
      ground = doorway.value_or(0);
    }
    point.position = {w.at.x(), w.at.y(), w.z.value_or(ground + path.eye_height)};
    point.pitch_rad = w.pitch_deg.value_or(path.pitch_deg) * pi / 180;
    point.pause_s = w.pause_s;
    points.push_back(point);
  }
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const WaypointPlan& w = path.waypoints[i];
    Eigen::Vector3d gaze = Eigen::Vector3d::UnitX();
    if (w.look) {
      gaze = Eigen::Vector3d(w.look->x(), w.look->y(), w.look_z.value_or(0)) - points[i].position;
      if (w.look_z) points[i].pitch_rad = std::atan2(gaze.z(), gaze.head<2>().norm());
    } else if (i + 1 < n || path.closed) {
      gaze = points[(i + 1) % n].position - points[i].position;
    } else if (i > 0) {
      gaze = points[i].position - points[i - 1].position;
    }
    points[i].yaw_rad = w.yaw_deg ? *w.yaw_deg * pi / 180 : std::atan2(gaze.y(), gaze.x());
  }
  return points;
}

bool in_doorway(const WallGeometry& wall, const Eigen::Vector3d& p) {
  const double along = (p.head<2>() - wall.p0).dot(wall.along), z = p.z() - wall.z_floor;
  for (const Opening& o : wall.openings) {
    if (along > o.along_min + door_clearance_m && along < o.along_max - door_clearance_m && z > o.z_min &&
        z < o.z_max - 0.05)
      return true;
  }
  return false;
}

// What stands in the camera's way at a point; empty if nothing does.
std::string obstacle(const Scene& scene, const Eigen::Vector3d& p) {
  const double clearance = scene.plan.path.clearance;
  for (const Solid& s : scene.solids) {
    const Eigen::Vector2d d = p.head<2>() - s.center;
    const double c = std::cos(s.yaw_rad), q = std::sin(s.yaw_rad);
    const bool near = std::abs(c * d.x() + q * d.y()) < s.half.x() + 0.5 * clearance &&
                      std::abs(-q * d.x() + c * d.y()) < s.half.y() + 0.5 * clearance;
    if (near && p.z() > s.z_min - 0.1 && p.z() < s.z_max + 0.1) return s.name;
  }
  for (std::size_t r = 0; r < scene.rooms.size(); ++r) {
    const RoomPlan& room = scene.plan.rooms[r];
    if (!contains(room.polygon, p.head<2>()) || p.z() < room.z_floor || p.z() > room.z_floor + room.height)
      continue;
    if (p.z() < ground_height(scene.plan, static_cast<int>(r), p.head<2>()) + 0.15)
      return "the ground of room \"" + room.id + "\"";
    if (p.z() > room.z_floor + ceiling_height(room, p.head<2>()) - 0.1)
      return "the ceiling of room \"" + room.id + "\"";
    for (const int w : scene.rooms[r].walls) {
      const WallGeometry& wall = scene.walls[static_cast<std::size_t>(w)];
      if (distance_to_segment(p.head<2>(), wall.p0, wall.p1) < clearance && !in_doorway(wall, p))
        return "wall " + std::to_string(wall.side) + " of room \"" + room.id + "\"";
    }
    return {};
  }
  for (const DoorGeometry& door : scene.doors) {
    const WallGeometry& wall = scene.walls[static_cast<std::size_t>(door.walls[0])];
    const double across = std::abs((p.head<2>() - door.center).dot(door.normal));
    if (across < 0.5 * door.thickness + 1e-6 && in_doorway(wall, p)) return {};
  }
  return "a wall (the point lies in no room)";
}

}  // namespace

CameraPath plan_path(const Scene& scene) {
  std::vector<ViewPoint> points = view_points(scene);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string what = obstacle(scene, points[i].position);
    require_input(what.empty(), waypoint(i) + ": stands in or too close to " + what);
  }
  CameraPath path(scene.plan.path, points, scene.plan.seed);
  for (double t = 0; t < path.duration_s() + check_step_s; t += check_step_s) {
    const Eigen::Vector3d p = path.world_from_camera(t).translation();
    const std::string what = obstacle(scene, p);
    if (what.empty()) continue;
    const auto i = static_cast<std::size_t>(path.waypoint_before(t));
    throw InputError(waypoint(i) + ": the way on from here comes too close to " + what + " at " + place(p) +
                     "; add a way-point around it");
  }
  return path;
}

}  // namespace vsgraphs
