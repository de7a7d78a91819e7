#include "core/matching/appearance.h"

#include "core/vision/matching.h"

namespace vsgraphs {

std::optional<Appearance> summarise_appearance(const Map& map, const Landmark& landmark) {
  // A landmark seen in very many keyframes looks in them much as it does in the last few.
  constexpr std::size_t max_observations = 24;
  std::vector<Descriptor> descriptors;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  std::optional<Appearance> result;
  const std::size_t count = landmark.observations.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && i + max_observations < count) continue;
    const Observation& o = landmark.observations[i];
    const Keyframe* keyframe = map.keyframes().find(o.keyframe);
    if (!keyframe) continue;
    const Eigen::Vector3d ray = landmark.point_in_world - keyframe->world_from_camera.translation();
    const double distance = ray.norm();
    if (distance <= 0) continue;
    direction += ray / distance;
    descriptors.push_back(keyframe->features->descriptor(o.feature));
    if (!result) {
      const Feature& feature = (*keyframe->features)[o.feature];
      result = Appearance{};
      result->reference_distance_m = static_cast<float>(distance);
      result->reference_level = feature.level;
      result->colour = feature.colour;
    }
  }
  if (!result) return result;
  result->descriptor = representative(descriptors);
  // Seen from opposite sides: any direction is as good as another.
  if (direction.norm() < 1e-9) direction = Eigen::Vector3d::UnitZ();
  result->view_direction = direction.normalized().cast<float>();
  return result;
}

}  // namespace vsgraphs
