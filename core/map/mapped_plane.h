// A planar surface of the world that keyframes observe: one face of a wall, a ground, a ceiling. A variable of the factor
// graph.
#pragma once

#include <vector>

#include "core/base/fields.h"
#include "core/map/ids.h"
#include "core/map/surface_patch.h"

namespace vsgraphs {

struct PlaneObservation {
  KeyframeId keyframe;      // may be retired: its patches still stand where it stood (Map::patch)
  std::uint16_t patch = 0;  // index into its KeyframeSurfaces
  bool operator==(const PlaneObservation&) const = default;
};
template <FieldsOf<PlaneObservation> T>
void visit_fields(T& v, auto& field) {
  auto& [keyframe, patch] = v;
  field(keyframe, patch);
}

struct MappedPlane {
  AnchoredPlane plane;  // in the world, towards the side that saw it
  SurfaceRole role = SurfaceRole::undecided;
  RoleVotes votes{};
  std::vector<PlaneObservation> observations;  // in the order they were made
  // The other face of the same wall, looking the other way, and the distance between them.
  PlaneId other_face;
  double thickness_m = 0;
  ClassVotes class_votes{};  // what a segmenter called it, by its own classes
};
template <FieldsOf<MappedPlane> T>
void visit_fields(T& v, auto& field) {
  auto& [plane, role, votes, observations, other_face, thickness_m, class_votes] = v;
  field(plane, role, votes, observations, other_face, thickness_m);
  field.since(5, class_votes);
}

}  // namespace vsgraphs
