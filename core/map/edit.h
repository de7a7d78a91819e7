// Edits: what a stage wants done to the map, as data. A stage works on a private `Draft`, which records every
// operation it does; the owner repeats them on the one map. Edits can be hashed, so two runs can be compared.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/map/keyframe.h"
#include "core/map/landmark.h"
#include "core/map/mapped_plane.h"
#include "core/map/marker.h"
#include "core/map/structure.h"

namespace vsgraphs {

class Map;

struct AddKeyframe {
  KeyframeId id;
  Keyframe keyframe;  // without landmarks: observations are operations of their own
};
// The keyframe's observations go with it; frames anchored to it are anchored to `anchor` from now on.
struct RemoveKeyframe {
  KeyframeId id;
  KeyframeId anchor;
  bool replaced = false;  // others show all that it saw: what it had carved of free space goes too
};
struct AddLandmark {
  LandmarkId id;
  Landmark landmark;  // without observations
};
struct RemoveLandmark {
  LandmarkId id;
};
// `id`'s observations go to `into` (where a keyframe has both, `into` keeps its own); `id` redirects to `into`.
struct MergeLandmark {
  LandmarkId id;
  LandmarkId into;
};
// Does nothing if the feature is taken or the keyframe observes the landmark already.
struct AddObservation {
  LandmarkId landmark;
  Observation observation;
};
// A landmark that loses its last observation goes too.
struct RemoveObservation {
  LandmarkId landmark;
  KeyframeId keyframe;
};
struct MoveKeyframe {
  KeyframeId id;
  Se3 world_from_camera;
};
// Does nothing where the keyframe, or the one the step begins at, has vanished.
struct SetOdometry {
  KeyframeId id;
  OdometryStep step;
};
struct MoveLandmark {
  LandmarkId id;
  Eigen::Vector3d point_in_world;
  // Where the landmark turns with the keyframe that it is anchored to; without, it is looked for from where it was.
  std::optional<Eigen::Vector3f> view_direction = std::nullopt;
};
struct SetAppearance {
  LandmarkId id;
  Appearance appearance;
};
struct CountSightings {
  LandmarkId id;
  std::uint32_t visible = 0;
  std::uint32_t found = 0;
};

// The planar pieces of a keyframe, or new ones (null: none) in place of the old: plane observations of the old ones go.
struct SetPatches {
  KeyframeId id;
  std::shared_ptr<const KeyframeSurfaces> patches;
};
struct AddPlane {
  PlaneId id;
  MappedPlane plane;  // without observations
};
struct RemovePlane {
  PlaneId id;
};
// `id`'s observations and votes go to `into`; `id` redirects to `into`.
struct MergePlane {
  PlaneId id;
  PlaneId into;
};
// Does nothing if the plane has it already or the keyframe has no such patch.
struct AddPlaneObservation {
  PlaneId plane;
  PlaneObservation observation;
};
// A plane that loses its last observation goes too.
struct RemovePlaneObservation {
  PlaneId plane;
  PlaneObservation observation;
};
struct MovePlane {
  PlaneId id;
  AnchoredPlane plane;
};
struct ClassifyPlane {
  PlaneId id;
  SurfaceRole role = SurfaceRole::undecided;
  RoleVotes votes{};
};
// What a segmenter called it, by its own classes.
struct SetPlaneClasses {
  PlaneId id;
  ClassVotes votes;
};
// Makes two planes the faces of one wall; an invalid `other` parts `id` from whatever it was paired with.
struct PairFaces {
  PlaneId id;
  PlaneId other;
  double thickness_m = 0;
};
// Unit vector; the direction rooms stand in.
struct SetUp {
  Eigen::Vector3d up_in_world;
};

// Rooms, floors, doors and places, all of them, in place of what was known before.
struct SetStructure {
  std::shared_ptr<const FoundStructure> structure;
};
// Of as many rooms and floors as there are; otherwise it does nothing (they were found anew meanwhile).
struct MoveStructureNodes {
  std::vector<Eigen::Vector3d> rooms, floors;
};

// Does nothing if the number is mapped already.
struct AddMarker {
  MarkerId id;
  MappedMarker marker;  // without observations
};
struct RemoveMarker {
  MarkerId id;
};
// Does nothing without the marker or where the keyframe never was.
struct AddMarkerObservation {
  MarkerId id;
  MarkerObservation observation;
};
// All that the keyframe saw of it. A marker that loses its last observation goes too.
struct RemoveMarkerObservations {
  MarkerId id;
  KeyframeId keyframe;
};
struct MoveMarker {
  MarkerId id;
  Se3 world_from_marker;
};
// Of classes that a segmenter named; a name that is known stays.
struct NameClasses {
  ClassNames names;
};
// The classes a segmenter named in a keyframe's image (null: none) in place of those before.
struct SetClasses {
  KeyframeId id;
  std::shared_ptr<const ClassGrid> classes;
};
// Where new ids begin.
struct FirstIds {
  std::uint32_t keyframe = 0, landmark = 0, plane = 0;
  static FirstIds later(const FirstIds& a, const FirstIds& b) {
    return {std::max(a.keyframe, b.keyframe), std::max(a.landmark, b.landmark), std::max(a.plane, b.plane)};
  }
};
// The map is the one being worked on from here: what is added gets ids behind those of all other maps, and versions go on
// from the one that was worked on before.
struct OpenMap {
  FirstIds first;
  std::uint64_t version = 0;
};
// Takes in all of another map, of which no id is in use here, moved by `world_from_other`. What was derived from it is not:
// rooms and floors are to be sought again; its up direction counts only where this map has none.
struct AbsorbMap {
  std::shared_ptr<const Map> other;
  Se3 world_from_other;
};

using EditOperation =
    std::variant<AddKeyframe, RemoveKeyframe, AddLandmark, RemoveLandmark, MergeLandmark, AddObservation,
                 RemoveObservation, MoveKeyframe, SetOdometry, MoveLandmark, SetAppearance, CountSightings,
                 SetPatches, AddPlane, RemovePlane, MergePlane, AddPlaneObservation, RemovePlaneObservation,
                 MovePlane, ClassifyPlane, PairFaces, SetUp, SetStructure, MoveStructureNodes, OpenMap,
                 AbsorbMap, AddMarker, RemoveMarker, AddMarkerObservation, RemoveMarkerObservations,
                 MoveMarker, NameClasses, SetClasses, SetPlaneClasses>;

struct MapEdit {
  std::uint64_t based_on = 0;  // version of the snapshot it was worked out on
  std::vector<EditOperation> operations;

  // Equal for equal edits, on every run of the same binary (FNV-1a over the values, floating point by bits).
  std::uint64_t hash() const;
};

}  // namespace vsgraphs
