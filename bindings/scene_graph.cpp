// From the map's structure to plain Python values.
#include <nanobind/stl/string.h>

#include <algorithm>
#include <set>
#include <string>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/classes.h"
#include "bindings/markers.h"
#include "core/map/map.h"

namespace nb = nanobind;

namespace vsgraphs {
namespace {

nb::object vector_of(const Eigen::Vector3d& v) {
  return nb::cast(to_numpy(std::vector<double>{v.x(), v.y(), v.z()}, {3}));
}

nb::object id_or_none(std::uint32_t index, bool valid) { return valid ? nb::cast(index) : nb::none(); }

nb::dict plane_of(const Map& map, PlaneId id, const MappedPlane& plane) {
  std::vector<float> points;
  std::set<std::uint32_t> keyframes;
  for (const PlaneObservation& o : plane.observations) {
    keyframes.insert(o.keyframe.index);
    const auto pose = map.resolve({o.keyframe, Se3{}});
    const SurfacePatch* patch = map.patch(o);
    if (!pose || !patch) continue;
    for (const Eigen::Vector3f& p : patch->points) {
      const Eigen::Vector3d q = *pose * p.cast<double>();
      for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(q[k]));
    }
  }
  nb::dict votes;
  for (std::size_t r = 1; r < surface_role_count; ++r) {
    if (plane.votes[r] > 0) votes[to_string(static_cast<SurfaceRole>(r))] = plane.votes[r];
  }
  nb::list observed_by;
  for (const std::uint32_t k : keyframes) observed_by.append(k);
  nb::dict d;
  d["id"] = id.index;
  d["role"] = to_string(plane.role);
  d["votes"] = votes;
  d["class_votes"] = class_votes_of(map, plane.class_votes);
  d["normal"] = vector_of(plane.plane.normal);
  d["d"] = plane.plane.d();
  d["anchor"] = vector_of(plane.plane.project(plane.plane.anchor));
  d["other_face"] = id_or_none(plane.other_face.index, plane.other_face.valid());
  d["thickness_m"] = plane.thickness_m;
  const std::size_t n = points.size() / 3;
  d["points"] = to_numpy(std::move(points), {n, 3});
  d["observed_by"] = observed_by;
  return d;
}

nb::object room_or_none(RoomNumber room) { return room == no_room ? nb::none() : nb::cast(room); }

template <typename Ids>
nb::list indices_of(const Ids& ids) {
  nb::list list;
  for (const auto& id : ids) list.append(id.index);
  return list;
}

nb::dict room_of(const FoundStructure& structure, std::size_t i, const Se3& world_from_level) {
  const FoundRoom& room = structure.rooms[i];
  std::vector<double> polygon;
  for (const Eigen::Vector2d& corner : room.polygon) {
    const Eigen::Vector3d p = world_from_level * Eigen::Vector3d(corner.x(), corner.y(), room.ground_m);
    polygon.insert(polygon.end(), {p.x(), p.y(), p.z()});
  }
  nb::object floor = nb::none();
  for (std::size_t f = 0; f < structure.floors.size(); ++f) {
    const auto& members = structure.floors[f].rooms;
    if (std::find(members.begin(), members.end(), room.number) != members.end()) floor = nb::cast(f);
  }
  const std::string kind = room.kind == RoomKind::corridor ? "corridor" : "room";
  nb::dict d;
  d["id"] = room.number;
  d["name"] = kind + " " + std::to_string(room.number + 1);
  d["kind"] = kind;
  d["walls"] = indices_of(room.walls);
  d["ground"] = id_or_none(room.ground.index, room.ground.valid());
  d["polygon"] = to_numpy(std::move(polygon), {room.polygon.size(), 3});
  d["centroid"] = vector_of(world_from_level * room.centroid);
  d["height_m"] = room.height_m ? nb::cast(*room.height_m) : nb::none();
  d["area_m2"] = room.area_m2;
  d["partial"] = room.partial;
  d["floor"] = floor;
  return d;
}

nb::dict floor_of(const FoundFloor& floor, std::size_t i, const Se3& world_from_level) {
  nb::list rooms;
  for (const RoomNumber room : floor.rooms) rooms.append(room);
  nb::dict d;
  d["id"] = i;
  d["rooms"] = rooms;
  d["ground"] = id_or_none(floor.grounds.empty() ? 0 : floor.grounds.front().index, !floor.grounds.empty());
  d["centroid"] = vector_of(world_from_level * floor.centroid);
  return d;
}

nb::dict door_of(const FoundDoor& door, std::size_t i, const Se3& world_from_level) {
  nb::list rooms;
  for (const RoomNumber room : door.rooms) rooms.append(room_or_none(room));
  nb::dict d;
  d["id"] = i;
  d["rooms"] = rooms;
  d["center"] = vector_of(world_from_level * door.position);
  d["width_m"] = door.width_m;
  d["height_m"] = door.height_m ? nb::cast(*door.height_m) : nb::none();
  d["normal"] = vector_of(world_from_level.rotation() * door.normal);
  d["kind"] = door.height_m ? "door" : "passage";
  return d;
}

nb::dict place_of(const Place& place, std::size_t i, const Se3& world_from_level) {
  nb::list neighbours;
  for (const std::uint32_t n : place.neighbours) neighbours.append(n);
  nb::dict d;
  d["id"] = i;
  d["position"] = vector_of(world_from_level * place.position);
  d["clearance_m"] = place.clearance_m;
  d["room"] = room_or_none(place.room);
  d["neighbours"] = neighbours;
  return d;
}

nb::dict element_of(const FoundElement& element, const Se3& world_from_level) {
  nb::list rooms;
  for (const RoomNumber room : element.rooms) rooms.append(room);
  nb::dict d;
  d["id"] = element.number;
  d["kind"] = element.kind;
  d["centre"] = vector_of(world_from_level * element.centre);
  d["along"] = vector_of(world_from_level.rotation() * element.along);
  d["size_m"] = vector_of(element.size_m);
  d["planes"] = indices_of(element.planes);
  d["rooms"] = rooms;
  return d;
}

void add_structure(const FoundStructure& structure, nb::dict& graph) {
  const Se3 world_from_level = structure.level_from_world.inverse();
  nb::list rooms, floors, doors, places, elements;
  for (std::size_t i = 0; i < structure.rooms.size(); ++i)
    rooms.append(room_of(structure, i, world_from_level));
  for (std::size_t i = 0; i < structure.floors.size(); ++i)
    floors.append(floor_of(structure.floors[i], i, world_from_level));
  for (std::size_t i = 0; i < structure.doors.size(); ++i)
    doors.append(door_of(structure.doors[i], i, world_from_level));
  for (std::size_t i = 0; i < structure.places.size(); ++i)
    places.append(place_of(structure.places[i], i, world_from_level));
  for (const FoundElement& element : structure.elements)
    elements.append(element_of(element, world_from_level));
  graph["rooms"] = rooms;
  graph["floors"] = floors;
  graph["doors"] = doors;
  graph["places"] = places;
  nb::list kinds;
  for (const std::string& kind : structure.element_kinds) kinds.append(kind);
  graph["element_kinds"] = kinds;
  graph["elements"] = elements;
}

}  // namespace

nb::dict scene_graph_of(const Map& map) {
  nb::dict graph;
  graph["up"] = map.up_in_world() ? vector_of(*map.up_in_world()) : nb::none();
  nb::list planes;
  map.planes().for_each(
      [&](PlaneId id, const MappedPlane& plane) { planes.append(plane_of(map, id, plane)); });
  graph["planes"] = planes;
  graph["markers"] = map.markers().empty() ? nb::object(nb::none()) : nb::object(markers_of(map));
  if (map.structure().sought) add_structure(map.structure(), graph);
  return graph;
}

}  // namespace vsgraphs
