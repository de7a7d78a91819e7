// What one keyframe saw of planar surfaces, condensed: kept in its camera frame, so that corrections of the keyframe move
// it for free.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/fields.h"
#include "core/geometry/plane.h"
#include "core/map/class_votes.h"

namespace vsgraphs {

// What a surface is to the scene. `undecided`: not enough known yet.
enum class SurfaceRole : std::uint8_t { undecided, wall, ground, ceiling, door, window, other };
inline constexpr std::size_t surface_role_count = 7;
template <>
inline constexpr std::size_t enum_size<SurfaceRole> = surface_role_count;
const char* to_string(SurfaceRole role);

// Sums of confidences, by role.
using RoleVotes = std::array<float, surface_role_count>;

// One connected piece of one plane.
struct SurfacePatch {
  AnchoredPlane plane;  // camera frame; anchored at the patch's centroid, normal towards the camera
  // Of (two tilts, offset) as AnchoredPlane::retract takes them, all readings summed up and scaled to as many
  // independent ones as they are worth.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Vector3f> points;  // camera frame, thinned out: its extent
  int samples = 0;                      // of the depth grid, on the plane
  float area_m2 = 0;
  RoleVotes votes{};         // of a segmenter; all zero without one
  ClassVotes class_votes{};  // likewise, by its own classes
};
template <FieldsOf<SurfacePatch> T>
void visit_fields(T& v, auto& field) {
  auto& [plane, information, points, samples, area_m2, votes, class_votes] = v;
  field(plane, information, points, samples, area_m2, votes);
  field.since(5, class_votes);
}

struct KeyframeSurfaces {
  std::vector<SurfacePatch> patches;
  bool labelled = false;  // a segmenter has had its say
};
template <>
inline constexpr const char* shared_name<KeyframeSurfaces> = "patches";
template <FieldsOf<KeyframeSurfaces> T>
void visit_fields(T& v, auto& field) {
  auto& [patches, labelled] = v;
  field(patches, labelled);
}

}  // namespace vsgraphs
