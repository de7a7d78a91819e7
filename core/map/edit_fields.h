// What each operation is made of, for whatever goes through edits (fields.h).
#pragma once

#include "core/base/fields.h"
#include "core/map/map.h"

namespace vsgraphs {

template <FieldsOf<AddKeyframe> T>
void visit_fields(T& v, auto& field) {
  auto& [id, keyframe] = v;
  field(id, keyframe);
}
template <FieldsOf<RemoveKeyframe> T>
void visit_fields(T& v, auto& field) {
  auto& [id, anchor, replaced] = v;
  field(id, anchor, replaced);
}
template <FieldsOf<AddLandmark> T>
void visit_fields(T& v, auto& field) {
  auto& [id, landmark] = v;
  field(id, landmark);
}
template <FieldsOf<RemoveLandmark> T>
void visit_fields(T& v, auto& field) {
  auto& [id] = v;
  field(id);
}
template <FieldsOf<MergeLandmark> T>
void visit_fields(T& v, auto& field) {
  auto& [id, into] = v;
  field(id, into);
}
template <FieldsOf<AddObservation> T>
void visit_fields(T& v, auto& field) {
  auto& [landmark, observation] = v;
  field(landmark, observation);
}
template <FieldsOf<RemoveObservation> T>
void visit_fields(T& v, auto& field) {
  auto& [landmark, keyframe] = v;
  field(landmark, keyframe);
}
template <FieldsOf<MoveKeyframe> T>
void visit_fields(T& v, auto& field) {
  auto& [id, world_from_camera] = v;
  field(id, world_from_camera);
}
template <FieldsOf<SetOdometry> T>
void visit_fields(T& v, auto& field) {
  auto& [id, step] = v;
  field(id, step);
}
template <FieldsOf<MoveLandmark> T>
void visit_fields(T& v, auto& field) {
  auto& [id, point_in_world, view_direction] = v;
  field(id, point_in_world, view_direction);
}
template <FieldsOf<SetAppearance> T>
void visit_fields(T& v, auto& field) {
  auto& [id, appearance] = v;
  field(id, appearance);
}
template <FieldsOf<CountSightings> T>
void visit_fields(T& v, auto& field) {
  auto& [id, visible, found] = v;
  field(id, visible, found);
}
template <FieldsOf<SetPatches> T>
void visit_fields(T& v, auto& field) {
  auto& [id, patches] = v;
  field(id, patches);
}
template <FieldsOf<AddPlane> T>
void visit_fields(T& v, auto& field) {
  auto& [id, plane] = v;
  field(id, plane);
}
template <FieldsOf<RemovePlane> T>
void visit_fields(T& v, auto& field) {
  auto& [id] = v;
  field(id);
}
template <FieldsOf<MergePlane> T>
void visit_fields(T& v, auto& field) {
  auto& [id, into] = v;
  field(id, into);
}
template <FieldsOf<AddPlaneObservation> T>
void visit_fields(T& v, auto& field) {
  auto& [plane, observation] = v;
  field(plane, observation);
}
template <FieldsOf<RemovePlaneObservation> T>
void visit_fields(T& v, auto& field) {
  auto& [plane, observation] = v;
  field(plane, observation);
}
template <FieldsOf<MovePlane> T>
void visit_fields(T& v, auto& field) {
  auto& [id, plane] = v;
  field(id, plane);
}
template <FieldsOf<ClassifyPlane> T>
void visit_fields(T& v, auto& field) {
  auto& [id, role, votes] = v;
  field(id, role, votes);
}
template <FieldsOf<SetPlaneClasses> T>
void visit_fields(T& v, auto& field) {
  auto& [id, votes] = v;
  field(id, votes);
}
template <FieldsOf<PairFaces> T>
void visit_fields(T& v, auto& field) {
  auto& [id, other, thickness_m] = v;
  field(id, other, thickness_m);
}
template <FieldsOf<SetUp> T>
void visit_fields(T& v, auto& field) {
  auto& [up_in_world] = v;
  field(up_in_world);
}
template <FieldsOf<SetStructure> T>
void visit_fields(T& v, auto& field) {
  auto& [structure] = v;
  field(structure);
}
template <FieldsOf<MoveStructureNodes> T>
void visit_fields(T& v, auto& field) {
  auto& [rooms, floors] = v;
  field(rooms, floors);
}
template <FieldsOf<AddMarker> T>
void visit_fields(T& v, auto& field) {
  auto& [id, marker] = v;
  field(id, marker);
}
template <FieldsOf<RemoveMarker> T>
void visit_fields(T& v, auto& field) {
  auto& [id] = v;
  field(id);
}
template <FieldsOf<AddMarkerObservation> T>
void visit_fields(T& v, auto& field) {
  auto& [id, observation] = v;
  field(id, observation);
}
template <FieldsOf<RemoveMarkerObservations> T>
void visit_fields(T& v, auto& field) {
  auto& [id, keyframe] = v;
  field(id, keyframe);
}
template <FieldsOf<MoveMarker> T>
void visit_fields(T& v, auto& field) {
  auto& [id, world_from_marker] = v;
  field(id, world_from_marker);
}
template <FieldsOf<NameClasses> T>
void visit_fields(T& v, auto& field) {
  auto& [names] = v;
  field(names);
}
template <FieldsOf<SetClasses> T>
void visit_fields(T& v, auto& field) {
  auto& [id, classes] = v;
  field(id, classes);
}
template <FieldsOf<FirstIds> T>
void visit_fields(T& v, auto& field) {
  auto& [keyframe, landmark, plane] = v;
  field(keyframe, landmark, plane);
}
template <FieldsOf<OpenMap> T>
void visit_fields(T& v, auto& field) {
  auto& [first, version] = v;
  field(first, version);
}
template <FieldsOf<AbsorbMap> T>
void visit_fields(T& v, auto& field) {
  auto& [other, world_from_other] = v;
  field(other, world_from_other);
}
template <FieldsOf<Map> T>
void visit_fields(T& map, auto& field) {
  visit_tables(map, [&field](const char*, auto& part, std::uint32_t = 1) { field(part); });
}

}  // namespace vsgraphs
