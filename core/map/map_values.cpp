// The numbers in a map.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/bounds.h"
#include "core/geometry/pose_covariance.h"
#include "core/map/map_checks.h"

namespace vsgraphs {

namespace {

constexpr std::int64_t most_frames = std::int64_t{1} << 53;
constexpr int most_levels = 16;       // of an image pyramid
constexpr double most_room_m2 = 1e6;  // with all around it; a storey is less (core/scene/rooms/level_map.cpp)
// A point that two views saw nearly alike may be anywhere along its rays.
constexpr double most_landmark_m = 1e8;

bool is_frame(std::int64_t index) { return index >= 0 && index < most_frames; }

bool all_within(const RoleVotes& votes) {
  return std::all_of(votes.begin(), votes.end(),
                     [](float vote) { return within(static_cast<double>(vote), most_information); });
}

bool is_sane(const KeyframeSurfaces* surfaces) {
  if (!surfaces) return true;
  return std::all_of(surfaces->patches.begin(), surfaces->patches.end(), [](const SurfacePatch& patch) {
    return is_plane(patch.plane) && within(patch.information, most_information) && patch.samples >= 0 &&
           patch.area_m2 >= 0 && within(static_cast<double>(patch.area_m2), most_metres * most_metres) &&
           all_within(patch.votes) && are_sane(patch.class_votes) &&
           std::all_of(patch.points.begin(), patch.points.end(),
                       [](const Eigen::Vector3f& point) { return within(point, most_metres); });
  });
}

bool is_sane(const Keyframe& keyframe) {
  const auto& link = keyframe.tracked_link;
  const auto& step = keyframe.odometry;
  if (step && !(is_pose(step->before_from_camera) && is_covariance(step->covariance))) return false;
  return is_frame(keyframe.frame_index) && std::isfinite(keyframe.timestamp_s) &&
         is_pose(keyframe.world_from_camera) && (!keyframe.surface || is_sane(*keyframe.surface)) &&
         is_sane(keyframe.patches.get()) &&
         (!link || (is_pose(link->to_from_camera) && within(link->information, most_information)));
}

bool is_sane(const Landmark& landmark) {
  const Appearance& look = landmark.appearance;
  return within(landmark.point_in_world, most_landmark_m) && within(look.view_direction, 2) &&
         look.reference_distance_m >= 0 &&
         look.reference_distance_m <= static_cast<float>(2 * most_landmark_m) &&
         look.reference_level < most_levels && is_frame(landmark.created_at_frame);
}

// As large and as far off as a detector may say (core/system/maps/markers.h).
bool is_sane(const MappedMarker& marker) {
  return marker.size_m > 0 && std::isfinite(marker.size_m) && is_pose(marker.world_from_marker) &&
         std::all_of(marker.observations.begin(), marker.observations.end(), [](const MarkerObservation& o) {
           return is_pose(o.camera_from_marker) && within(o.covariance, most_information);
         });
}

bool is_sane(const Polygon2& polygon) {
  if (polygon.size() < 3) return false;
  Eigen::Vector2d low = polygon[0], high = polygon[0];
  for (const Eigen::Vector2d& corner : polygon) {
    if (!within(corner, most_metres)) return false;
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return (high - low).prod() <= most_room_m2;
}

bool is_height(const std::optional<double>& height_m) { return !height_m || within(*height_m, most_metres); }

bool is_sane(const FoundRoom& room) {
  return is_sane(room.polygon) && within(room.centroid, most_metres) && within(room.ground_m, most_metres) &&
         within(room.area_m2, most_metres * most_metres) && is_height(room.height_m) &&
         within(room.closed_share, most_metres);
}

bool is_sane(const FoundDoor& door) {
  return within(door.position, most_metres) && within(door.normal, 2) && within(door.width_m, most_metres) &&
         is_height(door.height_m) && within(door.thickness_m, most_metres);
}

bool is_sane(const FoundFloor& floor) {
  return within(floor.ground_m, most_metres) && within(floor.centroid, most_metres) &&
         std::all_of(floor.extent.begin(), floor.extent.end(), [](const Polygon2& p) { return is_sane(p); });
}

bool is_sane(const Place& place) {
  return within(place.position, most_metres) && within(place.clearance_m, most_metres);
}

bool is_kind(const std::string& name) {
  constexpr std::size_t longest = 64;
  return !name.empty() && name.size() <= longest;
}

bool is_sane(const FoundElement& element) {
  return is_kind(element.kind) && within(element.centre, most_metres) && is_unit(element.along) &&
         within(element.size_m, most_metres);
}

template <typename Values>
bool all_sane(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](const auto& value) { return is_sane(value); });
}

Wrong wrong_with_structure(const FoundStructure& structure) {
  const auto nowhere = [](const Eigen::Vector3d& node) { return !within(node, most_metres); };
  if (!is_pose(structure.level_from_world) ||
      std::any_of(structure.room_nodes.begin(), structure.room_nodes.end(), nowhere) ||
      std::any_of(structure.floor_nodes.begin(), structure.floor_nodes.end(), nowhere))
    return "rooms or floors that are nowhere";
  if (!all_sane(structure.rooms)) return "a room of no shape";
  if (!all_sane(structure.doors)) return "a door of no size";
  if (!all_sane(structure.floors)) return "a floor of no shape";
  if (!all_sane(structure.elements) ||
      !std::all_of(structure.element_kinds.begin(), structure.element_kinds.end(), is_kind))
    return "an element of no size";
  return all_sane(structure.places) ? nullptr : "a place that is nowhere";
}

}  // namespace

bool is_sane(const DepthGrid& grid) {
  return std::all_of(grid.samples.begin(), grid.samples.end(), [](const SurfaceSample& sample) {
    return within(sample.point, most_metres) && within(sample.normal, 2);
  });
}

Wrong wrong_with_values(const Map& map) {
  Wrong wrong = nullptr;
  map.keyframes().for_each([&](KeyframeId, const Keyframe& keyframe) {
    if (!is_sane(keyframe)) wrong = "a keyframe that is nowhere, or saw what cannot be";
  });
  map.retired_keyframes().for_each([&](KeyframeId, const RetiredKeyframe& retired) {
    if (!is_pose(retired.anchor_from_camera) || !is_sane(retired.patches.get()))
      wrong = "a retired keyframe that is nowhere, or saw what cannot be";
  });
  map.landmarks().for_each([&](LandmarkId, const Landmark& landmark) {
    if (!is_sane(landmark)) wrong = "a landmark that is nowhere";
  });
  map.planes().for_each([&](PlaneId, const MappedPlane& plane) {
    if (!is_plane(plane.plane) || !all_within(plane.votes) || !are_sane(plane.class_votes) ||
        !within(plane.thickness_m, most_metres))
      wrong = "a plane that is nowhere";
  });
  for (const auto& [id, marker] : map.markers()) {
    if (!marker || !is_sane(*marker)) wrong = "a marker that is nowhere";
  }
  for (const auto& [id, name] : map.class_names()) {
    if (!is_class_name(name) || class_id(name) != id) wrong = "a class whose name is not its own";
  }
  if (map.up_in_world() && !is_unit(*map.up_in_world())) wrong = "an upward direction that is none";
  return wrong ? wrong : wrong_with_structure(map.structure());
}

}  // namespace vsgraphs
