// A landmark: a point of the world that several keyframes observe, a variable of the factor graph.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/fields.h"
#include "core/map/features.h"
#include "core/map/ids.h"

namespace vsgraphs {

struct Observation {
  KeyframeId keyframe;
  std::uint16_t feature = 0;  // index into the keyframe's FeatureSet
  bool operator==(const Observation&) const = default;
};
template <FieldsOf<Observation> T>
void visit_fields(T& v, auto& field) {
  auto& [keyframe, feature] = v;
  field(keyframe, feature);
}

// How a landmark looks, and from where it can be recognised.
struct Appearance {
  Descriptor descriptor;                                      // the observation nearest to all others
  Eigen::Vector3f view_direction = Eigen::Vector3f::UnitZ();  // mean unit vector camera -> point, world frame
  float reference_distance_m = 0;  // distance at which `reference_level` was observed
  std::uint8_t reference_level = 0;
  Rgb colour;
};
template <FieldsOf<Appearance> T>
void visit_fields(T& v, auto& field) {
  auto& [descriptor, view_direction, reference_distance_m, reference_level, colour] = v;
  field(descriptor, view_direction, reference_distance_m, reference_level, colour);
}

struct Landmark {
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
  Appearance appearance;
  std::vector<Observation> observations;  // in the order they were made
  std::int64_t created_at_frame = 0;
  std::uint32_t visible_count = 0;  // frames in which it should have been seen
  std::uint32_t found_count = 0;    // frames in which it was
};
template <FieldsOf<Landmark> T>
void visit_fields(T& v, auto& field) {
  auto& [point, appearance, observations, created_at_frame, visible_count, found_count] = v;
  field(point, appearance, observations, created_at_frame, visible_count, found_count);
}

}  // namespace vsgraphs
