// A map with everything that one can hold. For tests.
#pragma once

#include "core/map/test_map.h"

namespace vsgraphs::test {

inline std::shared_ptr<const DepthGrid> some_grid(float depth_m) {
  DepthGrid grid;
  grid.columns = 3;
  grid.rows = 2;
  for (int i = 0; i < 6; ++i)
    grid.samples.push_back({{0.1F * static_cast<float>(i), 0, depth_m}, -Eigen::Vector3f::UnitZ()});
  return std::make_shared<const DepthGrid>(std::move(grid));
}

inline std::shared_ptr<const KeyframeSurfaces> some_patches(int count) {
  KeyframeSurfaces surfaces;
  for (int i = 0; i < count; ++i) {
    SurfacePatch patch;
    patch.plane = {-Eigen::Vector3d::UnitZ(), {0, 0, 2.0 + i}, 0.001 * i};
    patch.information = Eigen::Vector3d(10, 20, 30).asDiagonal();
    patch.points = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
    patch.samples = 40;
    patch.area_m2 = 0.5F;
    patch.votes[1] = 0.25F;
    if (i == 1) patch.class_votes = {{class_id("picture"), 0.25F}};
    surfaces.patches.push_back(patch);
  }
  surfaces.labelled = true;
  return std::make_shared<const KeyframeSurfaces>(std::move(surfaces));
}

inline std::shared_ptr<const ClassGrid> some_classes() {
  const ClassId picture = class_id("picture"), chair = class_id("chair");
  LabelGrid labels{3, 2, {}, {{picture, "picture"}, {chair, "chair"}}};
  labels.samples = {{SurfaceRole::wall, 1, 0, picture}, {}, {SurfaceRole::other, 0.5F, 7, chair}, {}, {}, {}};
  return classes_of(labels);
}

inline FoundStructure some_structure(PlaneId wall, PlaneId ground) {
  FoundStructure structure;
  structure.sought = true;
  FoundRoom room;
  room.number = 4;
  room.walls = {wall};
  room.ground = ground;
  room.polygon = {{0, 0}, {3, 0}, {3, 2}};
  room.height_m = 2.5;
  room.kind = RoomKind::corridor;
  room.neighbours = {7};
  FoundRoom beside = room;
  beside.number = 7;
  beside.neighbours = {4};
  structure.rooms = {room, beside};
  FoundDoor door;
  door.width_m = 0.9;
  door.rooms = {4, 7};
  structure.doors = {door};
  FoundFloor floor;
  floor.rooms = {4};
  floor.grounds = {ground};
  floor.extent = {room.polygon};
  structure.floors = {floor};
  structure.places = {{{1, 1, 0}, 0.6, 4, {1}}, {{2, 1, 0}, 0.5, no_room, {0}}};
  structure.next_number = 8;
  FoundElement element;
  element.kind = "shelf";
  element.number = 2;
  element.size_m = {1, 0.1, 2};
  element.planes = {wall};
  element.rooms = {4};
  structure.element_kinds = {"shelf", "fountain"};
  structure.elements = {element};
  structure.next_element = 3;
  structure.level_from_world = Se3::exp((Vector6d() << 1, 2, 3, 0.1, 0.2, 0.3).finished());
  structure.room_nodes = {{1, 1, 1}, {4, 1, 1}};
  structure.floor_nodes = {{1, 1, 0}};
  return structure;
}

inline void add_points(Map& map) {
  const Camera camera;
  const auto points = point_grid(6, 4);
  std::vector<KeyframeId> keyframes;
  map.apply(NameClasses{{{class_id("picture"), "picture"}, {class_id("chair"), "chair"}}});
  for (int i = 0; i < 4; ++i) {
    Keyframe keyframe = keyframe_seeing(camera, standing_at(0.1 * i), points);
    keyframe.frame_index = 10 * i;
    keyframe.timestamp_s = 0.1 * i;
    keyframe.surface = some_grid(2.0F + 0.1F * static_cast<float>(i));
    if (i == 2) keyframe.tracked_link = TrackedLink{keyframes[0], standing_at(0.2), Matrix6d::Identity()};
    keyframes.push_back(add_keyframe(map, keyframe));
    map.apply(SetPatches{keyframes.back(), some_patches(3)});
    if (i > 1) map.apply(SetClasses{keyframes.back(), some_classes()});
  }
  map.apply(SetOdometry{keyframes[2], {}});
  map.apply(SetOdometry{keyframes[3], {keyframes[2], standing_at(0.1), 1e-4 * Matrix6d::Identity()}});
  const auto landmarks = add_landmarks(map, points, {keyframes[0], keyframes[1], keyframes[2]});
  const auto twin = add_landmark(map, points[0], 0, {{keyframes[3], 0}});
  map.apply(MergeLandmark{twin, landmarks[0]});
  for (const int gone : {5, 3, 4}) map.apply(RemoveLandmark{landmarks[static_cast<std::size_t>(gone)]});
  add_landmark(map, points[5], 5, {{keyframes[3], 5}});  // where a landmark was
  map.apply(CountSightings{landmarks[1], 5, 3});
  map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  map.apply(RemoveKeyframe{keyframes[0], keyframes[2]});  // the first one's anchor goes too
}

inline void add_planes(Map& map) {
  const auto keyframe = map.keyframes().at_index(2);
  const auto retired = map.retired_keyframes().at_index(0);
  std::vector<PlaneId> planes;
  for (std::uint16_t i = 0; i < 3; ++i) {
    MappedPlane plane;
    plane.role = i == 0 ? SurfaceRole::ground : SurfaceRole::wall;
    plane.votes[1] = 0.5F;
    if (i == 1) plane.class_votes = {{class_id("picture"), 0.5F}};
    planes.push_back(map.planes().next_id());
    map.apply(AddPlane{planes.back(), plane});
    map.apply(AddPlaneObservation{planes.back(), {keyframe, i}});
    map.apply(AddPlaneObservation{planes.back(), {retired, i}});
  }
  MappedPlane doubled;
  const PlaneId twin = map.planes().next_id();
  map.apply(AddPlane{twin, doubled});
  map.apply(MergePlane{twin, planes[1]});
  map.apply(PairFaces{planes[1], planes[2], 0.12});
  map.apply(SetUp{{0, -1, 0.1}});
  map.apply(SetStructure{std::make_shared<const FoundStructure>(some_structure(planes[1], planes[0]))});
  map.apply(MapEdit{});
}

inline void add_markers(Map& map) {
  const auto keyframe = map.keyframes().at_index(2);
  for (const std::uint32_t number : {3U, 40U}) {
    const MarkerId id{number};
    map.apply(AddMarker{id, {0.01 * number, standing_at(number), {}}});
    map.apply(AddMarkerObservation{id, {keyframe, standing_at(1), 0.5 * Matrix6d::Identity()}});
  }
}

// With everything a map can hold.
inline Map full_map() {
  Map map;
  add_points(map);
  add_planes(map);
  add_markers(map);
  return map;
}

}  // namespace vsgraphs::test
