// A landmark: a point of the world that several keyframes observe, a variable of the factor graph.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/map/features.h"
#include "core/map/ids.h"

namespace vsgraphs {

struct Observation {
  KeyframeId keyframe;
  std::uint16_t feature = 0;  // index into the keyframe's FeatureSet
  bool operator==(const Observation&) const = default;
};

// How a landmark looks, and from where it can be recognised.
struct Appearance {
  Descriptor descriptor;                                      // the observation nearest to all others
  Eigen::Vector3f view_direction = Eigen::Vector3f::UnitZ();  // mean unit vector camera -> point, world frame
  float reference_distance_m = 0;  // distance at which `reference_level` was observed
  std::uint8_t reference_level = 0;
  Rgb colour;
};

struct Landmark {
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
  Appearance appearance;
  std::vector<Observation> observations;  // in the order they were made
  std::int64_t created_at_frame = 0;
  std::uint32_t visible_count = 0;  // frames in which it should have been seen
  std::uint32_t found_count = 0;    // frames in which it was
};

}  // namespace vsgraphs
