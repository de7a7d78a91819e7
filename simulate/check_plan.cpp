// What can be said about a plan without building it: numbers in range, names known, polygons sound.
#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/check.h"
#include "simulate/marker_bits.h"
#include "simulate/scene_builder.h"

namespace vsgraphs {
namespace {

std::string at(const char* list, std::size_t i) { return std::string(list) + "[" + std::to_string(i) + "]"; }

std::string shown(double x) {
  std::string text = std::to_string(x);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

void in_range(double value, double low, double high, const std::string& key) {
  require_input(std::isfinite(value) && value >= low && value <= high,
                key + ": must lie in " + shown(low) + ".." + shown(high) + ", not " + shown(value));
}

void one_of(const std::string& value, const std::vector<std::string>& known, const std::string& key) {
  if (std::find(known.begin(), known.end(), value) != known.end()) return;
  std::string list;
  for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
  throw InputError(key + ": unknown kind \"" + value + "\" (known: " + list + ")");
}

void check_point(const Eigen::Vector2d& p, const std::string& key) {
  in_range(p.x(), -1000, 1000, key + "[0]");
  in_range(p.y(), -1000, 1000, key + "[1]");
}

void check_room(const RoomPlan& room, const std::string& key) {
  require_input(!room.id.empty(), key + ".id: must not be empty");
  one_of(room.kind, {"room", "corridor", "stairs"}, key + ".kind");
  one_of(room.floor, floor_kinds(), key + ".floor");
  one_of(room.ceiling, {"panels", "plain"}, key + ".ceiling");
  require_input(room.polygon.size() >= 3,
                key + ".polygon: needs at least 3 corners, not " + std::to_string(room.polygon.size()));
  for (std::size_t i = 0; i < room.polygon.size(); ++i)
    check_point(room.polygon[i], at((key + ".polygon").c_str(), i));
  require_input(
      is_simple(room.polygon, 0.05),
      key + ".polygon: edges cross, touch or are shorter than 0.05 m; list the corners once, in order");
  require_input(signed_area(room.polygon) > 0,
                key + ".polygon: runs clockwise; list the corners counter-clockwise seen from above");
  in_range(room.z_floor, -100, 100, key + ".z_floor");
  in_range(room.height, 1.8, 20, key + ".height");
  in_range(room.brightness, 0, 5, key + ".brightness");
  if (room.slope) {
    in_range(room.slope->wall, 0, static_cast<double>(room.polygon.size() - 1), key + ".slope.wall");
    in_range(room.slope->knee, 0.2, room.height, key + ".slope.knee");
    in_range(room.slope->reach, 0.1, 100, key + ".slope.reach");
  }
  if (room.lamps) {
    for (std::size_t i = 0; i < room.lamps->size(); ++i) {
      check_point((*room.lamps)[i], at((key + ".lamps").c_str(), i));
      require_input(contains(room.polygon, (*room.lamps)[i]),
                    at((key + ".lamps").c_str(), i) + ": lies outside the room");
    }
  }
}

void check_path(const PathPlan& path, const std::string& key) {
  in_range(path.eye_height, 0.2, 3, key + ".eye_height");
  in_range(path.speed, 0.05, 3, key + ".speed");
  in_range(path.turn_rate, 2, 180, key + ".turn_rate");
  in_range(path.pitch_deg, -80, 80, key + ".pitch_deg");
  in_range(path.shake, 0, 10, key + ".shake");
  in_range(path.smooth_s, 0, 5, key + ".smooth_s");
  in_range(path.clearance, 0.05, 1, key + ".clearance");
  if (path.robot) {
    in_range(path.robot->width, 0.05, 3, key + ".robot.width");
    in_range(path.robot->ahead, 0.05, 3, key + ".robot.ahead");
    in_range(path.robot->below, 0.02, 2, key + ".robot.below");
  }
  require_input(!path.waypoints.empty(), key + ".waypoints: must not be empty");
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const WaypointPlan& w = path.waypoints[i];
    const std::string here = at((key + ".waypoints").c_str(), i);
    check_point(w.at, here + ".at");
    if (w.z) in_range(*w.z, -100, 100, here + ".z");
    if (w.yaw_deg) in_range(*w.yaw_deg, -3600, 3600, here + ".yaw_deg");
    if (w.pitch_deg) in_range(*w.pitch_deg, -80, 80, here + ".pitch_deg");
    in_range(w.pause_s, 0, 600, here + ".pause_s");
    require_input(!(w.look && w.yaw_deg), here + ": give either \"look\" or \"yaw_deg\", not both");
    require_input(!w.look_z || (w.look && !w.pitch_deg),
                  here + ".look_z: goes with \"look\" and without \"pitch_deg\"");
    if (w.look_z) in_range(*w.look_z, -100, 100, here + ".look_z");
    if (w.look) {
      check_point(*w.look, here + ".look");
      require_input((*w.look - w.at).norm() > 0.05, here + ".look: lies at the way-point itself");
    }
  }
}

void check_things(const Plan& plan) {
  for (std::size_t i = 0; i < plan.doors.size(); ++i) {
    const DoorPlan& d = plan.doors[i];
    const std::string key = at("doors", i);
    require_input(d.rooms.size() == 2 && d.rooms[0] != d.rooms[1],
                  key + ".rooms: must name two different rooms");
    check_point(d.at, key + ".at");
    in_range(d.width, 0.4, 10, key + ".width");
    in_range(d.height, 1.5, 10, key + ".height");
    if (!d.leaf) continue;
    in_range(d.leaf->angle_deg, 0, 180, key + ".leaf.angle_deg");
    one_of(d.leaf->hinge, {"left", "right"}, key + ".leaf.hinge");
    in_range(d.leaf->set_back, 0, 0.5, key + ".leaf.set_back");
    double before = 0;
    for (std::size_t k = 0; k < d.leaf->turns.size(); ++k) {
      const std::string turn = at((key + ".leaf.turns").c_str(), k);
      in_range(d.leaf->turns[k].x(), before, 1e5, turn + "[0]");
      in_range(d.leaf->turns[k].y(), 0, 180, turn + "[1]");
      before = d.leaf->turns[k].x();
    }
    require_input(d.leaf->room == d.rooms[0] || d.leaf->room == d.rooms[1],
                  key + ".leaf.room: must be one of the door's two rooms, not \"" + d.leaf->room + "\"");
  }
  for (std::size_t i = 0; i < plan.windows.size(); ++i) {
    const WindowPlan& w = plan.windows[i];
    in_range(w.width, 0.3, 20, at("windows", i) + ".width");
    in_range(w.height, 0.3, 20, at("windows", i) + ".height");
    in_range(w.sill, 0, 20, at("windows", i) + ".sill");
    one_of(w.view, {"picture", "parapet", "street"}, at("windows", i) + ".view");
  }
  for (std::size_t i = 0; i < plan.posters.size(); ++i) {
    const PosterPlan& p = plan.posters[i];
    one_of(p.kind, poster_kinds(), at("posters", i) + ".kind");
    in_range(p.width, 0.02, 10, at("posters", i) + ".width");
    in_range(p.height, 0.02, 10, at("posters", i) + ".height");
  }
  for (std::size_t i = 0; i < plan.markers.size(); ++i) {
    in_range(plan.markers[i].id, 0, static_cast<double>(marker_bits.size() - 1), at("markers", i) + ".id");
    in_range(plan.markers[i].size, 0.02, 2, at("markers", i) + ".size");
  }
  for (std::size_t i = 0; i < plan.boxes.size(); ++i) {
    const BoxPlan& b = plan.boxes[i];
    const std::string key = at("boxes", i);
    one_of(b.kind, furniture_kinds(), key + ".kind");
    check_point(b.at, key + ".at");
    in_range(b.z, 0, 20, key + ".z");
    in_range(b.yaw_deg, -3600, 3600, key + ".yaw_deg");
    for (int k = 0; k < 3; ++k)
      in_range(b.size[k], 0.005, 20, at((key + ".size").c_str(), static_cast<std::size_t>(k)));
  }
  for (std::size_t i = 0; i < plan.stairs.size(); ++i) {
    const StairsPlan& s = plan.stairs[i];
    const std::string key = at("stairs", i);
    check_point(s.from, key + ".from"), check_point(s.to, key + ".to");
    require_input((s.to - s.from).norm() > 0.1, key + ".to: must differ from \"from\"");
    in_range(s.width, 0.3, 20, key + ".width");
    in_range(s.rise, 0.05, 20, key + ".rise");
    in_range(s.steps, 1, 200, key + ".steps");
    in_range(s.landing, 0, 20, key + ".landing");
  }
}

void check_partitions(const Plan& plan) {
  for (std::size_t i = 0; i < plan.partitions.size(); ++i) {
    const PartitionPlan& p = plan.partitions[i];
    const std::string key = at("partitions", i);
    one_of(p.kind, {"solid", "glass"}, key + ".kind");
    check_point(p.from, key + ".from"), check_point(p.to, key + ".to");
    require_input((p.to - p.from).norm() > 0.1, key + ".to: must differ from \"from\"");
    in_range(p.height, 0.2, 20, key + ".height");
    in_range(p.thickness, 0.01, 1, key + ".thickness");
    in_range(p.mullions, 0.2, 100, key + ".mullions");
  }
}

void check_movers(const Plan& plan) {
  for (std::size_t i = 0; i < plan.movers.size(); ++i) {
    const MoverPlan& m = plan.movers[i];
    const std::string key = at("movers", i);
    one_of(m.kind, {"person", "trolley"}, key + ".kind");
    one_of(m.pose, {"walk", "stand", "sit"}, key + ".pose");
    require_input(!m.way.empty(), key + ".way: must not be empty");
    for (std::size_t k = 0; k < m.way.size(); ++k) {
      const std::string point = at((key + ".way").c_str(), k);
      check_point(m.way[k], point);
      require_input(k == 0 || (m.way[k] - m.way[k - 1]).norm() > 0.05, point + ": lies at the point before");
    }
    in_range(m.speed, 0.05, 5, key + ".speed");
    in_range(m.start_s, 0, 1e5, key + ".start_s");
    in_range(m.yaw_deg, -3600, 3600, key + ".yaw_deg");
  }
}

}  // namespace

void check_plan(const Plan& plan) {
  require_input(!plan.rooms.empty(), "rooms: must not be empty");
  in_range(plan.fps, 0.5, 240, "fps");
  std::set<std::string> ids;
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    check_room(plan.rooms[i], at("rooms", i));
    require_input(ids.insert(plan.rooms[i].id).second,
                  at("rooms", i) + ".id: \"" + plan.rooms[i].id + "\" is used twice");
  }
  check_things(plan);
  check_partitions(plan);
  check_movers(plan);
  check_path(plan.path, "path");
}

}  // namespace vsgraphs
