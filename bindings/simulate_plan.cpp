#include "bindings/simulate_plan.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>
#include <vector>

#include "simulate/plan.h"

namespace nb = nanobind;

namespace vsgraphs {
namespace {

using Pair = std::array<double, 2>;
using Triple = std::array<double, 3>;
using Bytes = std::array<std::uint8_t, 3>;

// What Python sees of a field: points and colours as tuples of numbers.
Pair shown(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }
Triple shown(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
Bytes shown(const Rgb& c) { return {c.r, c.g, c.b}; }
Eigen::Vector2d stored(const Pair& p) { return {p[0], p[1]}; }
Eigen::Vector3d stored(const Triple& p) { return {p[0], p[1], p[2]}; }
Rgb stored(const Bytes& c) { return {c[0], c[1], c[2]}; }

std::vector<Pair> shown(const Polygon2& points) {
  std::vector<Pair> out;
  for (const auto& p : points) out.push_back(shown(p));
  return out;
}
Polygon2 stored(const std::vector<Pair>& points) {
  Polygon2 out;
  for (const auto& p : points) out.push_back(stored(p));
  return out;
}

template <typename T>
auto shown(const std::optional<T>& value) {
  using Shown = decltype(shown(*value));
  return value ? std::optional<Shown>(shown(*value)) : std::nullopt;
}
template <typename T>
auto stored(const std::optional<T>& value) {
  using Stored = decltype(stored(*value));
  return value ? std::optional<Stored>(stored(*value)) : std::nullopt;
}

template <typename Class, typename Value>
void translated(nb::class_<Class>& cls, const char* name, Value Class::* member) {
  using Shown = decltype(shown(std::declval<const Value&>()));
  cls.def_prop_rw(
      name, [member](const Class& c) { return shown(c.*member); },
      [member](Class& c, const Shown& value) { c.*member = stored(value); }, nb::arg("value").none());
}

void bind_room(nb::module_& m) {
  nb::class_<SlopePlan>(m, "SlopePlan")
      .def(nb::init<>())
      .def_rw("wall", &SlopePlan::wall)
      .def_rw("knee", &SlopePlan::knee)
      .def_rw("reach", &SlopePlan::reach);
  auto room = nb::class_<RoomPlan>(m, "RoomPlan").def(nb::init<>());
  room.def_rw("id", &RoomPlan::id)
      .def_rw("kind", &RoomPlan::kind)
      .def_rw("z_floor", &RoomPlan::z_floor)
      .def_rw("height", &RoomPlan::height)
      .def_rw("level", &RoomPlan::level)
      .def_rw("counted", &RoomPlan::counted)
      .def_rw("skirting", &RoomPlan::skirting)
      .def_rw("floor", &RoomPlan::floor)
      .def_rw("ceiling", &RoomPlan::ceiling)
      .def_rw("brightness", &RoomPlan::brightness)
      .def_rw("slope", &RoomPlan::slope, nb::arg("value").none());
  translated(room, "polygon", &RoomPlan::polygon);
  translated(room, "wall_colour", &RoomPlan::wall_colour);
  translated(room, "lamps", &RoomPlan::lamps);
}

void bind_openings(nb::module_& m) {
  auto leaf = nb::class_<DoorLeafPlan>(m, "DoorLeafPlan");
  leaf.def(nb::init<>())
      .def_rw("room", &DoorLeafPlan::room)
      .def_rw("angle_deg", &DoorLeafPlan::angle_deg)
      .def_rw("hinge", &DoorLeafPlan::hinge)
      .def_rw("set_back", &DoorLeafPlan::set_back)
      .def_rw("pair", &DoorLeafPlan::pair);
  translated(leaf, "turns", &DoorLeafPlan::turns);
  auto door = nb::class_<DoorPlan>(m, "DoorPlan").def(nb::init<>());
  door.def_rw("rooms", &DoorPlan::rooms)
      .def_rw("width", &DoorPlan::width)
      .def_rw("height", &DoorPlan::height)
      .def_rw("leaf", &DoorPlan::leaf, nb::arg("value").none());
  translated(door, "at", &DoorPlan::at);
  nb::class_<WindowPlan>(m, "WindowPlan")
      .def(nb::init<>())
      .def_rw("room", &WindowPlan::room)
      .def_rw("wall", &WindowPlan::wall)
      .def_rw("along", &WindowPlan::along)
      .def_rw("width", &WindowPlan::width)
      .def_rw("height", &WindowPlan::height)
      .def_rw("sill", &WindowPlan::sill)
      .def_rw("radiator", &WindowPlan::radiator)
      .def_rw("curtain", &WindowPlan::curtain)
      .def_rw("view", &WindowPlan::view)
      .def_rw("seed", &WindowPlan::seed);
}

void bind_things(nb::module_& m) {
  nb::class_<PosterPlan>(m, "PosterPlan")
      .def(nb::init<>())
      .def_rw("room", &PosterPlan::room)
      .def_rw("wall", &PosterPlan::wall)
      .def_rw("along", &PosterPlan::along)
      .def_rw("z", &PosterPlan::z)
      .def_rw("width", &PosterPlan::width)
      .def_rw("height", &PosterPlan::height)
      .def_rw("kind", &PosterPlan::kind)
      .def_rw("seed", &PosterPlan::seed);
  nb::class_<MarkerPlan>(m, "MarkerPlan")
      .def(nb::init<>())
      .def_rw("id", &MarkerPlan::id)
      .def_rw("room", &MarkerPlan::room)
      .def_rw("wall", &MarkerPlan::wall)
      .def_rw("along", &MarkerPlan::along)
      .def_rw("z", &MarkerPlan::z)
      .def_rw("size", &MarkerPlan::size);
  auto box = nb::class_<BoxPlan>(m, "BoxPlan").def(nb::init<>());
  box.def_rw("kind", &BoxPlan::kind)
      .def_rw("room", &BoxPlan::room)
      .def_rw("z", &BoxPlan::z)
      .def_rw("yaw_deg", &BoxPlan::yaw_deg)
      .def_rw("seed", &BoxPlan::seed);
  translated(box, "at", &BoxPlan::at);
  translated(box, "size", &BoxPlan::size);
  translated(box, "colour", &BoxPlan::colour);
  auto stairs = nb::class_<StairsPlan>(m, "StairsPlan").def(nb::init<>());
  stairs.def_rw("room", &StairsPlan::room)
      .def_rw("width", &StairsPlan::width)
      .def_rw("rise", &StairsPlan::rise)
      .def_rw("steps", &StairsPlan::steps)
      .def_rw("landing", &StairsPlan::landing);
  translated(stairs, "from_", &StairsPlan::from);  // `from` is a word of Python's
  translated(stairs, "to", &StairsPlan::to);
}

void bind_partitions_and_movers(nb::module_& m) {
  auto partition = nb::class_<PartitionPlan>(m, "PartitionPlan").def(nb::init<>());
  partition.def_rw("room", &PartitionPlan::room)
      .def_rw("height", &PartitionPlan::height)
      .def_rw("thickness", &PartitionPlan::thickness)
      .def_rw("kind", &PartitionPlan::kind)
      .def_rw("mullions", &PartitionPlan::mullions);
  translated(partition, "from_", &PartitionPlan::from);
  translated(partition, "to", &PartitionPlan::to);
  auto mover = nb::class_<MoverPlan>(m, "MoverPlan").def(nb::init<>());
  mover.def_rw("kind", &MoverPlan::kind)
      .def_rw("room", &MoverPlan::room)
      .def_rw("pose", &MoverPlan::pose)
      .def_rw("speed", &MoverPlan::speed)
      .def_rw("start_s", &MoverPlan::start_s)
      .def_rw("yaw_deg", &MoverPlan::yaw_deg)
      .def_rw("seed", &MoverPlan::seed);
  translated(mover, "way", &MoverPlan::way);
  nb::class_<RobotPlan>(m, "RobotPlan")
      .def(nb::init<>())
      .def_rw("width", &RobotPlan::width)
      .def_rw("ahead", &RobotPlan::ahead)
      .def_rw("below", &RobotPlan::below);
}

void bind_path(nb::module_& m) {
  auto waypoint = nb::class_<WaypointPlan>(m, "WaypointPlan").def(nb::init<>());
  waypoint.def_rw("room", &WaypointPlan::room)
      .def_rw("z", &WaypointPlan::z, nb::arg("value").none())
      .def_rw("yaw_deg", &WaypointPlan::yaw_deg, nb::arg("value").none())
      .def_rw("pitch_deg", &WaypointPlan::pitch_deg, nb::arg("value").none())
      .def_rw("look_z", &WaypointPlan::look_z, nb::arg("value").none())
      .def_rw("pause_s", &WaypointPlan::pause_s);
  translated(waypoint, "at", &WaypointPlan::at);
  translated(waypoint, "look", &WaypointPlan::look);
  nb::class_<PathPlan>(m, "PathPlan")
      .def(nb::init<>())
      .def_rw("eye_height", &PathPlan::eye_height)
      .def_rw("speed", &PathPlan::speed)
      .def_rw("turn_rate", &PathPlan::turn_rate)
      .def_rw("pitch_deg", &PathPlan::pitch_deg)
      .def_rw("shake", &PathPlan::shake)
      .def_rw("smooth_s", &PathPlan::smooth_s)
      .def_rw("clearance", &PathPlan::clearance)
      .def_rw("closed", &PathPlan::closed)
      .def_rw("waypoints", &PathPlan::waypoints)
      .def_rw("robot", &PathPlan::robot, nb::arg("value").none());
}

}  // namespace

void bind_plan(nb::module_& m) {
  bind_room(m);
  bind_openings(m);
  bind_things(m);
  bind_partitions_and_movers(m);
  bind_path(m);
  nb::class_<Plan>(m, "Plan", "A place and a walk through it; docs/simulator.md explains every field.")
      .def(nb::init<>())
      .def_rw("name", &Plan::name)
      .def_rw("description", &Plan::description)
      .def_rw("seed", &Plan::seed)
      .def_rw("fps", &Plan::fps)
      .def_rw("rooms", &Plan::rooms)
      .def_rw("doors", &Plan::doors)
      .def_rw("windows", &Plan::windows)
      .def_rw("posters", &Plan::posters)
      .def_rw("markers", &Plan::markers)
      .def_rw("boxes", &Plan::boxes)
      .def_rw("stairs", &Plan::stairs)
      .def_rw("partitions", &Plan::partitions)
      .def_rw("movers", &Plan::movers)
      .def_rw("path", &Plan::path);
}

}  // namespace vsgraphs
