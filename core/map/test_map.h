// Small maps for tests: points of known place, seen exactly by cameras of known pose, every point with a look of its
// own. Feature i of a keyframe shows the i-th of the points it was given.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/rng.h"
#include "core/geometry/camera.h"
#include "core/map/map.h"

namespace vsgraphs::test {

using Points = std::vector<Eigen::Vector3d>;

inline Se3 standing_at(double x, double y = 0, double z = 0) {
  return {Eigen::Matrix3d::Identity(), {x, y, z}};
}

// `columns` x `rows` points 0.2 m apart, their middle at (x, 0, z); depth varies a little so that no plane holds all.
inline Points point_grid(int columns, int rows, double x = 0, double z = 2.0) {
  Points points;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      points.emplace_back(x + 0.2 * (c - 0.5 * (columns - 1)), 0.2 * (r - 0.5 * (rows - 1)),
                          z + 0.1 * ((c + 2 * r) % 3));
  return points;
}

// The look of point `name`: two of them differ in about half of their bits.
inline Descriptor descriptor_of(int name) {
  Rng rng(1, "test_map", static_cast<std::uint64_t>(name));
  Descriptor descriptor;
  for (std::uint64_t& word : descriptor.words) word = rng.next();
  return descriptor;
}

// How the point appears: exact pixel and depth, at pyramid level 0.
inline Feature feature_of(const Camera& camera, const Se3& world_from_camera, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = world_from_camera.inverse() * point;
  const Eigen::Vector2d pixel = camera.project(p);
  Feature feature;
  feature.u = static_cast<float>(pixel.x());
  feature.v = static_cast<float>(pixel.y());
  feature.depth_m = static_cast<float>(p.z());
  return feature;
}

// A keyframe that sees all the points; point i looks like `first_name + i`.
inline Keyframe keyframe_seeing(const Camera& camera, const Se3& world_from_camera, const Points& points,
                                int first_name = 0) {
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    features.push_back(feature_of(camera, world_from_camera, points[i]));
    descriptors.push_back(descriptor_of(first_name + static_cast<int>(i)));
  }
  Keyframe keyframe;
  keyframe.world_from_camera = world_from_camera;
  keyframe.features = std::make_shared<const FeatureSet>(std::move(features), std::move(descriptors),
                                                         camera.width, camera.height);
  return keyframe;
}

// The same keyframe with its features changed: `change(std::vector<Feature>&)`.
template <typename Change>
Keyframe with_features_changed(Keyframe keyframe, const Camera& camera, Change&& change) {
  std::vector<Feature> features = keyframe.features->features();
  change(features);
  keyframe.features = std::make_shared<const FeatureSet>(
      std::move(features), keyframe.features->descriptors(), camera.width, camera.height);
  return keyframe;
}

inline KeyframeId add_keyframe(Map& map, Keyframe keyframe) {
  const KeyframeId id = map.keyframes().next_id();
  map.apply(AddKeyframe{id, std::move(keyframe)});
  return id;
}

// A landmark that looks like `name` from straight ahead, observed where told.
inline LandmarkId add_landmark(Map& map, const Eigen::Vector3d& point, int name,
                               const std::vector<Observation>& observations) {
  Landmark landmark;
  landmark.point_in_world = point;
  landmark.appearance.descriptor = descriptor_of(name);
  landmark.appearance.reference_distance_m = static_cast<float>(point.norm());
  const LandmarkId id = map.landmarks().next_id();
  map.apply(AddLandmark{id, landmark});
  for (const Observation& o : observations) map.apply(AddObservation{id, o});
  return id;
}

// One landmark per point, observed as feature i by every one of `keyframes`.
inline std::vector<LandmarkId> add_landmarks(Map& map, const Points& points,
                                             const std::vector<KeyframeId>& keyframes) {
  std::vector<LandmarkId> ids;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<Observation> observations;
    for (const KeyframeId keyframe : keyframes)
      observations.push_back({keyframe, static_cast<std::uint16_t>(i)});
    ids.push_back(add_landmark(map, points[i], static_cast<int>(i), observations));
  }
  return ids;
}

}  // namespace vsgraphs::test
