#include "core/map/map_archive.h"

#include <algorithm>
#include <vector>

namespace vsgraphs {

namespace {

// nullptr if all is well.
const char* wrong_with_keyframes(const Map& map) {
  const char* wrong = nullptr;
  map.keyframes().for_each([&](KeyframeId, const Keyframe& keyframe) {
    if (!keyframe.features) {
      wrong = "a keyframe without features";
    } else if (keyframe.landmarks.size() != static_cast<std::size_t>(keyframe.features->size())) {
      wrong = "a keyframe whose landmarks do not fit its features";
    } else if (!keyframe.world_from_camera.finite()) {
      wrong = "a keyframe that is nowhere";
    }
  });
  return wrong;
}

// Anchors must lead to a living keyframe: following them has no other end.
const char* wrong_with_anchors(const Map& map) {
  const auto& retired = map.retired_keyframes();
  bool paired = retired.index_bound() == map.keyframes().index_bound();
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { paired = paired && retired.contains(id); });
  if (!paired) return "keyframes without their place among the retired ones";
  std::vector<bool> leads(retired.index_bound(), false);
  std::vector<KeyframeId> way;
  for (std::uint32_t start = 0; start < retired.index_bound(); ++start) {
    way.clear();
    KeyframeId at = retired.at_index(start);
    if (!at.valid()) continue;
    while (!map.keyframes().contains(at)) {
      const RetiredKeyframe* entry = retired.find(at);
      if (!entry || way.size() > retired.size()) return "a retired keyframe without a living anchor";
      if (leads[at.index]) break;
      way.push_back(at);
      at = entry->anchor;
    }
    for (const KeyframeId id : way) leads[id.index] = true;
  }
  return nullptr;
}

const char* wrong_with_landmarks(const Map& map) {
  const char* wrong = nullptr;
  map.landmarks().for_each([&](LandmarkId, const Landmark& landmark) {
    for (const Observation& o : landmark.observations) {
      const Keyframe* keyframe = map.keyframes().find(o.keyframe);
      if (!keyframe || o.feature >= keyframe->landmarks.size()) wrong = "a landmark seen by nothing";
    }
  });
  return wrong;
}

const char* wrong_with_planes(const Map& map) {
  const char* wrong = nullptr;
  map.planes().for_each([&](PlaneId, const MappedPlane& plane) {
    const auto nowhere = [&map](const PlaneObservation& o) { return map.patch(o) == nullptr; };
    if (std::any_of(plane.observations.begin(), plane.observations.end(), nowhere))
      wrong = "a plane seen where nothing was";
    if (plane.other_face.valid() && !map.planes().contains(plane.other_face))
      wrong = "a wall whose other face is missing";
  });
  const auto missing = [&map](PlaneId id) { return id.valid() && !map.planes().contains(id); };
  const auto& structure = map.structure();
  for (const FoundRoom& room : structure.rooms) {
    if (std::any_of(room.walls.begin(), room.walls.end(), missing) || missing(room.ground) ||
        missing(room.ceiling))
      wrong = "a room without its walls";
  }
  for (const FoundFloor& floor : structure.floors) {
    if (std::any_of(floor.grounds.begin(), floor.grounds.end(), missing))
      wrong = "a floor without its ground";
  }
  for (const Place& place : structure.places) {
    for (const std::uint32_t next : place.neighbours) {
      if (next >= structure.places.size()) wrong = "a place beside one that does not exist";
    }
  }
  return wrong;
}

const char* wrong_with_markers(const Map& map) {
  for (const auto& [id, marker] : map.markers()) {
    if (!marker || !marker->world_from_marker.finite()) return "a marker that is nowhere";
  }
  return nullptr;
}

}  // namespace

void save_map(ArchiveWriter& archive, const std::string& prefix, const Map& map) {
  visit_tables(map, [&](const char* name, const auto& part) { archive.add(prefix + "/" + name, part); });
}

Map load_map(const ArchiveReader& archive, const std::string& prefix) {
  Map map;
  visit_tables(map, [&](const char* name, auto& part) { archive.read(prefix + "/" + name, part); });
  for (const auto check : {wrong_with_keyframes, wrong_with_anchors, wrong_with_landmarks, wrong_with_planes,
                           wrong_with_markers}) {
    if (const char* wrong = check(map)) archive.damaged(wrong);
  }
  return map;
}

void load_shared_constants(ArchiveReader& archive) {
  archive.load_shared<FeatureSet>();
  archive.load_shared<DepthGrid>();
  archive.load_shared<KeyframeSurfaces>();
  archive.load_shared<MappedMarker>();
}

}  // namespace vsgraphs
