// Which rooms can be seen at all, through doorways.
#include <algorithm>

#include "simulate/visibility.h"

namespace vsgraphs {
namespace {

constexpr double near_m = 0.02;

struct Window {  // part of the image
  double u0, v0, u1, v1;
};

// The part of `window` a doorway fills; false if none of it.
bool through_door(const DoorGeometry& door, const View& view, Window& window) {
  const Camera& k = *view.camera;
  const Eigen::Vector2d along(-door.normal.y(), door.normal.x());
  Window seen{1e9, 1e9, -1e9, -1e9};
  int behind = 0;
  for (const double side : {-0.5, 0.5}) {
    for (const double z : {door.z, door.z + door.height}) {
      const Eigen::Vector2d p = door.center + side * door.width * along;
      const Eigen::Vector3d c = view.camera_from_world * Eigen::Vector3d(p.x(), p.y(), z);
      if (c.z() < near_m) {
        ++behind;
        continue;
      }
      const double u = k.fx * c.x() / c.z() + k.cx, v = k.fy * c.y() / c.z() + k.cy;
      seen = {std::min(seen.u0, u), std::min(seen.v0, v), std::max(seen.u1, u), std::max(seen.v1, v)};
    }
  }
  if (behind == 4) return false;
  if (behind > 0) return true;  // reaches past the camera: no narrower bound
  window = {std::max(window.u0, seen.u0 - 1), std::max(window.v0, seen.v0 - 1),
            std::min(window.u1, seen.u1 + 1), std::min(window.v1, seen.v1 + 1)};
  return window.u0 < window.u1 && window.v0 < window.v1;
}

void visit(const Scene& scene, const View& view, int room, const Window& window, std::vector<bool>& seen,
           std::vector<bool>& passed) {
  seen[static_cast<std::size_t>(room)] = true;
  for (std::size_t i = 0; i < scene.doors.size(); ++i) {
    const DoorGeometry& door = scene.doors[i];
    if (passed[i] || (door.rooms[0] != room && door.rooms[1] != room)) continue;
    Window narrowed = window;
    if (!through_door(door, view, narrowed)) continue;
    passed[i] = true;  // a line of sight passes a doorway at most once
    visit(scene, view, door.rooms[0] == room ? door.rooms[1] : door.rooms[0], narrowed, seen, passed);
    passed[i] = false;
  }
}

}  // namespace

std::vector<bool> visible_rooms(const Scene& scene, const View& view) {
  const Eigen::Vector3d eye = view.camera_from_world.inverse().translation();
  const Window image{-1, -1, static_cast<double>(view.camera->width),
                     static_cast<double>(view.camera->height)};
  std::vector<bool> seen(scene.rooms.size(), false), passed(scene.doors.size(), false);
  bool inside = false;
  for (std::size_t r = 0; r < scene.rooms.size(); ++r) {
    const RoomPlan& room = scene.plan.rooms[r];
    if (!contains(room.polygon, eye.head<2>()) || eye.z() < room.z_floor ||
        eye.z() > room.z_floor + room.height)
      continue;
    visit(scene, view, static_cast<int>(r), image, seen, passed);
    inside = true;
  }
  if (inside) return seen;
  return std::vector<bool>(scene.rooms.size(), true);  // in a doorway: draw everything
}

}  // namespace vsgraphs
