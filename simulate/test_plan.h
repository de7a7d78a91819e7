// For the tests of core/simulate only: a small place whose every surface can be worked out by hand.
#pragma once

#include "core/geometry/camera.h"
#include "simulate/scene.h"

namespace vsgraphs::testing {

// Room A (5 x 4 m, height 2.6) and B (4 x 4 m) beyond a wall of 0.2 m with a door of 1 x 2 m in its middle; one box of
// 0.6 m a side stands in A. The camera looks along +x from (1, 2), then walks into B.
inline Plan two_rooms_plan() {
  Plan plan;
  plan.name = "test";
  RoomPlan a, b;
  a.id = "A";
  a.polygon = {{0, 0}, {5, 0}, {5, 4}, {0, 4}};
  a.skirting = false;
  b.id = "B";
  b.polygon = {{5.2, 0}, {9.2, 0}, {9.2, 4}, {5.2, 4}};
  b.skirting = false;
  plan.rooms = {a, b};
  DoorPlan door;
  door.rooms = {"A", "B"};
  door.at = {5.1, 2};
  door.width = 1.0;
  door.height = 2.0;
  plan.doors = {door};
  BoxPlan box;
  box.room = "A";
  box.at = {3, 3.2};
  box.size = {0.6, 0.6, 0.6};
  plan.boxes = {box};
  WaypointPlan start, end;
  start.at = {1, 2};
  start.yaw_deg = 0;
  start.pause_s = 0.5;
  end.at = {7, 2};
  end.yaw_deg = 0;
  plan.path.waypoints = {start, end};
  plan.path.shake = 0;
  plan.path.pitch_deg = 0;
  return plan;
}

inline Camera small_camera() {
  Camera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = camera.fy = 131.25;
  camera.cx = 79.5;
  camera.cy = 59.5;
  return camera;
}

}  // namespace vsgraphs::testing
