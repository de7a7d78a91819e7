// The ids in a map.
#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "core/map/map_checks.h"

namespace vsgraphs {

namespace {

Wrong wrong_with_keyframes(const Map& map) {
  Wrong wrong = nullptr;
  const auto& retired = map.retired_keyframes();
  for (std::uint32_t index = 0; index < retired.index_bound(); ++index) {
    const KeyframeId id = retired.at_index(index);
    if (id.valid() &&
        (map.stretch_of(id).index > index || map.stretch_of(map.stretch_of(id)) != map.stretch_of(id)))
      wrong = "a keyframe of a stretch that does not exist";
  }
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    if (!keyframe.features)
      wrong = "a keyframe without features";
    else if (keyframe.landmarks.size() != static_cast<std::size_t>(keyframe.features->size()))
      wrong = "a keyframe whose landmarks do not fit its features";
    else if (keyframe.tracked_link && !map.retired_keyframes().contains(keyframe.tracked_link->to))
      wrong = "a keyframe linked with one that does not exist";
    else if (keyframe.odometry && keyframe.odometry->before.valid() &&
             (keyframe.odometry->before.index >= id.index ||
              !map.keyframes().contains(keyframe.odometry->before)))
      wrong = "a keyframe that comes after one that does not exist";
  });
  return wrong;
}

// Anchors must lead to a living keyframe: following them has no other end.
Wrong wrong_with_anchors(const Map& map) {
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

// Keyframes and landmarks name each other: an observation for every entry, and at most one of a keyframe for a landmark.
Wrong wrong_with_landmarks(const Map& map) {
  Wrong wrong = nullptr;
  std::size_t observations = 0, entries = 0;
  std::vector<std::uint32_t> last_seen(map.keyframes().index_bound(), LandmarkId::none);
  map.landmarks().for_each([&](LandmarkId id, const Landmark& landmark) {
    for (const Observation& o : landmark.observations) {
      const Keyframe* keyframe = map.keyframes().find(o.keyframe);
      if (!keyframe || o.feature >= keyframe->landmarks.size() || keyframe->landmarks[o.feature] != id)
        wrong = "a landmark seen by nothing";
      else if (std::exchange(last_seen[o.keyframe.index], id.index) == id.index)
        wrong = "a landmark seen twice by one keyframe";
    }
    observations += landmark.observations.size();
  });
  map.keyframes().for_each([&](KeyframeId, const Keyframe& keyframe) {
    for (const LandmarkId id : keyframe.landmarks) entries += id.valid() ? 1 : 0;
  });
  return !wrong && entries != observations ? "a keyframe that sees a landmark which does not exist" : wrong;
}

Wrong wrong_with_planes(const Map& map) {
  Wrong wrong = nullptr;
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    const auto nowhere = [&map](const PlaneObservation& o) { return map.patch(o) == nullptr; };
    if (std::any_of(plane.observations.begin(), plane.observations.end(), nowhere))
      wrong = "a plane seen where nothing was";
    if (!plane.other_face.valid()) return;
    const MappedPlane* other = map.planes().find(plane.other_face);
    if (!other || other->other_face != id || plane.other_face == id)
      wrong = "a wall whose other face is missing";
  });
  return wrong;
}

Wrong wrong_with_classes(const Map& map) {
  const ClassNames& names = map.class_names();
  const auto unnamed = [&names](const KeyframeSurfaces* surfaces) {
    return surfaces &&
           !std::all_of(surfaces->patches.begin(), surfaces->patches.end(),
                        [&](const SurfacePatch& patch) { return are_named(patch.class_votes, names); });
  };
  bool named = true;
  map.keyframes().for_each([&](KeyframeId, const Keyframe& keyframe) {
    named = named && !unnamed(keyframe.patches.get());
    if (!keyframe.classes) return;
    for (const ClassId id : keyframe.classes->classes) named = named && names.contains(id);
  });
  map.retired_keyframes().for_each(
      [&](KeyframeId, const RetiredKeyframe& retired) { named = named && !unnamed(retired.patches.get()); });
  map.planes().for_each(
      [&](PlaneId, const MappedPlane& plane) { named = named && are_named(plane.class_votes, names); });
  return named ? nullptr : "a class without a name";
}

Wrong wrong_with_markers(const Map& map) {
  for (const auto& [id, marker] : map.markers()) {
    if (!marker) return "a marker that is nowhere";
    for (const MarkerObservation& o : marker->observations) {
      if (!map.retired_keyframes().contains(o.keyframe)) return "a marker seen by nothing";
    }
  }
  return nullptr;
}

Wrong wrong_with_surfaces_of(const FoundStructure& structure, const Map& map) {
  const auto missing = [&map](PlaneId id) { return !map.planes().contains(id); };
  for (const FoundRoom& room : structure.rooms) {
    if (std::any_of(room.walls.begin(), room.walls.end(), missing) ||
        (room.ground.valid() && missing(room.ground)) || (room.ceiling.valid() && missing(room.ceiling)))
      return "a room without its walls";
  }
  for (const FoundFloor& floor : structure.floors) {
    if (std::any_of(floor.grounds.begin(), floor.grounds.end(), missing)) return "a floor without its ground";
  }
  for (const FoundElement& element : structure.elements) {
    if (std::any_of(element.planes.begin(), element.planes.end(), missing))
      return "an element without its planes";
  }
  return nullptr;
}

Wrong wrong_with_rooms(const FoundStructure& structure) {
  if (structure.room_nodes.size() != structure.rooms.size() ||
      structure.floor_nodes.size() != structure.floors.size())
    return "rooms or floors that are nowhere";
  std::set<RoomNumber> numbers;
  for (const FoundRoom& room : structure.rooms) {
    if (room.number >= structure.next_number || !numbers.insert(room.number).second)
      return "a room's number that was not given to it";
  }
  const auto unknown = [&](RoomNumber number) { return number != no_room && !numbers.contains(number); };
  for (const FoundRoom& room : structure.rooms) {
    if (std::any_of(room.neighbours.begin(), room.neighbours.end(), unknown))
      return "a room beside one that does not exist";
  }
  for (const FoundDoor& door : structure.doors) {
    if (std::any_of(door.rooms.begin(), door.rooms.end(), unknown))
      return "a door into a room that does not exist";
  }
  for (const FoundFloor& floor : structure.floors) {
    if (std::any_of(floor.rooms.begin(), floor.rooms.end(), unknown))
      return "a floor with a room that does not exist";
  }
  std::set<ElementNumber> elements;
  for (const FoundElement& element : structure.elements) {
    if (element.number >= structure.next_element || !elements.insert(element.number).second)
      return "an element's number that was not given to it";
    if (std::any_of(element.rooms.begin(), element.rooms.end(), unknown))
      return "an element in a room that does not exist";
  }
  for (const Place& place : structure.places) {
    const auto behind_the_end = [&](std::uint32_t next) { return next >= structure.places.size(); };
    if (unknown(place.room) || std::any_of(place.neighbours.begin(), place.neighbours.end(), behind_the_end))
      return "a place beside one, or in a room, that does not exist";
  }
  return nullptr;
}

}  // namespace

Wrong wrong_with_references(const Map& map) {
  for (const auto check : {wrong_with_keyframes, wrong_with_anchors, wrong_with_landmarks, wrong_with_planes,
                           wrong_with_markers, wrong_with_classes}) {
    if (Wrong wrong = check(map)) return wrong;
  }
  if (Wrong wrong = wrong_with_surfaces_of(map.structure(), map)) return wrong;
  return wrong_with_rooms(map.structure());
}

}  // namespace vsgraphs
