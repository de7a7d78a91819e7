#include "bindings/simulate_truth.h"

#include <nanobind/stl/string.h>

#include <cmath>

namespace nb = nanobind;

namespace vsgraphs {
namespace {

// Nanometres and 1e-9 of a unit normal: drops the dust of floating point, and -0.
double tidy(double x) { return std::round(x * 1e9) / 1e9 + 0.0; }

nb::list numbers(std::initializer_list<double> values) {
  nb::list out;
  for (const double v : values) out.append(tidy(v));
  return out;
}

template <typename Index>
const auto& item(const auto& list, Index i) {
  return list[static_cast<std::size_t>(i)];
}

nb::dict room_truth(const Scene& scene, const ObservationCounter& seen, std::size_t r) {
  const RoomPlan& plan = scene.plan.rooms[r];
  const RoomGeometry& geometry = scene.rooms[r];
  const Eigen::Vector2d c = centroid(plan.polygon);
  nb::dict d;
  nb::list polygon, walls;
  for (const auto& p : plan.polygon) polygon.append(numbers({p.x(), p.y()}));
  for (const int w : geometry.walls) walls.append(w);
  d["id"] = plan.id;
  d["polygon"] = polygon;
  d["centroid"] = numbers({c.x(), c.y(), plan.z_floor});
  d["area"] = tidy(signed_area(plan.polygon));
  d["level"] = plan.level;
  d["z_floor"] = plan.z_floor;
  d["height"] = plan.height;
  d["counted"] = plan.counted;
  d["kind"] = plan.kind;
  d["walls"] = walls;
  d["floor_inst"] = geometry.floor_instance;
  d["ceiling_inst"] = geometry.ceiling_instance;
  d["visited"] = seen.visited(static_cast<int>(r));
  d["floor_observed_frames"] = seen.frames_seen(geometry.floor_instance);
  if (plan.slope) {
    nb::dict slope;
    slope["wall"] = plan.slope->wall;
    slope["knee"] = plan.slope->knee;
    slope["reach"] = plan.slope->reach;
    d["slope"] = slope;
  }
  return d;
}

nb::dict wall_truth(const Scene& scene, const ObservationCounter& seen, std::size_t index) {
  const WallGeometry& w = scene.walls[index];
  nb::dict d;
  d["id"] = index;
  d["inst"] = w.instance;
  d["room"] = item(scene.plan.rooms, w.room).id;
  d["side"] = w.side;
  d["p0"] = numbers({w.p0.x(), w.p0.y(), w.z_floor});
  d["p1"] = numbers({w.p1.x(), w.p1.y(), w.z_floor});
  d["length"] = tidy(w.length);
  d["height"] = w.height;
  d["n"] = numbers({w.normal.x(), w.normal.y(), 0});
  d["d"] = tidy(-w.normal.dot(w.p0));
  d["area"] = tidy(w.area());
  d["counted"] = item(scene.plan.rooms, w.room).counted;
  d["observed_frames"] = seen.frames_seen(w.instance);
  d["observed_mean_px_share"] = std::round(seen.mean_share(w.instance) * 1e5) / 1e5;
  d["observed"] = seen.observed(w.instance);
  return d;
}

nb::dict door_truth(const Scene& scene, std::size_t index) {
  const DoorGeometry& door = scene.doors[index];
  nb::dict d;
  nb::list rooms;
  for (const int r : door.rooms) rooms.append(item(scene.plan.rooms, r).id);
  d["id"] = index;
  d["inst"] = door.instance;
  d["rooms"] = rooms;
  d["center"] = numbers({door.center.x(), door.center.y(), door.z});
  d["width"] = door.width;
  d["height"] = door.height;
  d["normal"] = numbers({door.normal.x(), door.normal.y(), 0});
  if (const auto& leaf = scene.plan.doors[index].leaf) {
    nb::dict l;
    l["inst"] = door.leaf_instance;
    l["room"] = leaf->room;
    l["angle_deg"] = leaf->angle_deg;
    if (leaf->set_back > 0) l["set_back"] = leaf->set_back;
    if (leaf->pair) l["second_inst"] = door.second_leaf_instance;
    if (!leaf->turns.empty()) {
      nb::list turns;
      for (const auto& turn : leaf->turns) turns.append(numbers({turn.x(), turn.y()}));
      l["turns"] = turns;
    }
    d["leaf"] = l;
  }
  return d;
}

nb::dict window_truth(const Scene& scene, std::size_t index) {
  const WindowGeometry& w = scene.windows[index];
  nb::dict d;
  d["id"] = index;
  d["inst"] = w.instance;
  d["room"] = item(scene.plan.rooms, w.room).id;
  d["center"] = numbers({w.center.x(), w.center.y(), w.center.z()});
  d["width"] = w.width;
  d["height"] = w.height;
  if (const auto& view = scene.plan.windows[index].view; view != "picture") d["view"] = view;
  return d;
}

nb::dict mirror_truth(const Scene& scene, std::size_t index) {
  const MirrorGeometry& m = scene.wall_mirrors[index];
  nb::dict d;
  d["id"] = index;
  d["inst"] = m.instance;
  d["room"] = item(scene.plan.rooms, m.room).id;
  d["center"] = numbers({m.center.x(), m.center.y(), m.center.z()});
  d["n"] = numbers({m.normal.x(), m.normal.y(), m.normal.z()});
  d["width"] = m.width;
  d["height"] = m.height;
  return d;
}

nb::dict partition_truth(const Scene& scene, std::size_t index) {
  const PartitionGeometry& p = scene.partitions[index];
  const PartitionPlan& plan = scene.plan.partitions[index];
  nb::dict d;
  d["id"] = index;
  d["inst"] = p.instance;
  d["room"] = plan.room;
  d["kind"] = plan.kind;
  d["p0"] = numbers({p.from.x(), p.from.y(), p.from.z()});
  d["p1"] = numbers({p.to.x(), p.to.y(), p.to.z()});
  d["height"] = plan.height;
  d["thickness"] = plan.thickness;
  return d;
}

nb::dict mover_truth(const Scene& scene, std::size_t index) {
  const MoverPlan& plan = scene.plan.movers[index];
  nb::dict d;
  nb::list way;
  for (const auto& p : plan.way) way.append(numbers({p.x(), p.y()}));
  d["id"] = index;
  d["inst"] = scene.moving[index];
  d["kind"] = plan.kind;
  d["room"] = plan.room;
  if (plan.kind == "person") d["pose"] = plan.pose;
  d["way"] = way;
  return d;
}

nb::dict pillar_truth(const BoxPlan& box, const RoomPlan& room, std::size_t index) {
  nb::dict d;
  d["id"] = index;
  d["room"] = room.id;
  d["center"] = numbers({box.at.x(), box.at.y(), room.z_floor + box.z + 0.5 * box.size.z()});
  d["size"] = numbers({box.size.x(), box.size.y(), box.size.z()});
  return d;
}

// Only where there are any.
void add_pillars(const Scene& scene, nb::dict& truth) {
  nb::list pillars;
  for (const BoxPlan& box : scene.plan.boxes) {
    if (box.kind != "pillar") continue;
    for (const RoomPlan& room : scene.plan.rooms)
      if (room.id == box.room) pillars.append(pillar_truth(box, room, pillars.size()));
  }
  if (pillars.size() > 0) truth["pillars"] = pillars;
}

nb::dict marker_truth(const Scene& scene, std::size_t index) {
  const MarkerGeometry& marker = scene.markers[index];
  const Eigen::Matrix4d pose = marker.world_from_marker.matrix();
  nb::list rows;
  for (int r = 0; r < 4; ++r) rows.append(numbers({pose(r, 0), pose(r, 1), pose(r, 2), pose(r, 3)}));
  nb::dict d;
  d["id"] = scene.plan.markers[index].id;
  d["dictionary"] = "4x4_50";
  d["inst"] = marker.instance;
  d["room"] = item(scene.plan.rooms, marker.room).id;
  d["size_m"] = scene.plan.markers[index].size;
  d["world_from_marker"] = rows;
  return d;
}

nb::dict instance_truth(const Scene& scene, std::size_t index) {
  const Instance& instance = scene.instances[index];
  nb::dict d;
  d["id"] = index;
  d["cls"] = std::string(scene_class_names[static_cast<std::size_t>(instance.label)]);
  if (!instance.room.empty()) d["room"] = instance.room;
  if (instance.side >= 0) d["side"] = instance.side;
  if (instance.door >= 0) d["door"] = instance.door;
  if (!instance.kind.empty()) d["kind"] = instance.kind;
  return d;
}

nb::dict level_plane(const Scene& scene, std::size_t r, bool ceiling) {
  const RoomPlan& plan = scene.plan.rooms[r];
  nb::dict d;
  d["inst"] = ceiling ? scene.rooms[r].ceiling_instance : scene.rooms[r].floor_instance;
  d["room"] = plan.id;
  if (!ceiling) d["level"] = plan.level;
  d["n"] = numbers({0, 0, ceiling ? -1.0 : 1.0});
  d["d"] = tidy(ceiling ? plan.z_floor + plan.height : -plan.z_floor);
  return d;
}

bool occurs(const Scene& scene, SceneClass label) {
  for (const Instance& instance : scene.instances)
    if (instance.label == label) return true;
  return false;
}

template <typename Make>
nb::list listed(std::size_t count, const Make& make) {
  nb::list out;
  for (std::size_t i = 0; i < count; ++i) out.append(make(i));
  return out;
}

}  // namespace

nb::dict scene_truth(const Scene& scene, const ObservationCounter& seen) {
  nb::dict d;
  d["rooms"] = listed(scene.rooms.size(), [&](std::size_t i) { return room_truth(scene, seen, i); });
  d["walls"] = listed(scene.walls.size(), [&](std::size_t i) { return wall_truth(scene, seen, i); });
  d["floors"] = listed(scene.rooms.size(), [&](std::size_t i) { return level_plane(scene, i, false); });
  d["ceilings"] = listed(scene.rooms.size(), [&](std::size_t i) { return level_plane(scene, i, true); });
  d["doors"] = listed(scene.doors.size(), [&](std::size_t i) { return door_truth(scene, i); });
  d["windows"] = listed(scene.windows.size(), [&](std::size_t i) { return window_truth(scene, i); });
  // Only where there are any: plans without markers keep their files to the byte.
  if (!scene.markers.empty())
    d["markers"] = listed(scene.markers.size(), [&](std::size_t i) { return marker_truth(scene, i); });
  if (!scene.wall_mirrors.empty())
    d["mirrors"] = listed(scene.wall_mirrors.size(), [&](std::size_t i) { return mirror_truth(scene, i); });
  add_pillars(scene, d);
  if (!scene.partitions.empty())
    d["partitions"] =
        listed(scene.partitions.size(), [&](std::size_t i) { return partition_truth(scene, i); });
  if (!scene.moving.empty())
    d["movers"] = listed(scene.moving.size(), [&](std::size_t i) { return mover_truth(scene, i); });
  d["instances"] = listed(scene.instances.size(), [&](std::size_t i) { return instance_truth(scene, i); });
  nb::dict classes;
  for (std::size_t i = 0; i < scene_class_names.size(); ++i)
    if (i < first_rare_class || occurs(scene, static_cast<SceneClass>(i)))
      classes[std::string(scene_class_names[i]).c_str()] = i;
  d["classes"] = classes;
  d["adjacency"] = listed(scene.doors.size(), [&](std::size_t i) {
    nb::list rooms;
    for (const int r : scene.doors[i].rooms) rooms.append(item(scene.plan.rooms, r).id);
    return rooms;
  });
  return d;
}

}  // namespace vsgraphs
