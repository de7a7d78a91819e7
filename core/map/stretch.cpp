#include "core/map/stretch.h"

#include <algorithm>

namespace vsgraphs {

namespace {

// From its first living keyframe through the others to `end`.
double way_of(const Map& map, KeyframeId stretch, const Se3& end) {
  std::optional<Eigen::Vector3d> last;
  double way_m = 0;
  const auto go_to = [&](const Eigen::Vector3d& next) {
    if (last) way_m += (next - *last).norm();
    last = next;
  };
  for (std::uint32_t index = stretch.index; index < map.keyframes().index_bound(); ++index) {
    const Keyframe* keyframe = map.keyframes().find(map.keyframes().at_index(index));
    if (keyframe && keyframe->stretch == stretch) go_to(keyframe->world_from_camera.translation());
  }
  go_to(end.translation());
  return way_m;
}

bool tied(const Map& map, KeyframeId stretch, std::span<const LandmarkId> landmarks,
          const std::optional<TrackedLink>& link) {
  if (link && map.stretch_of(link->to) == stretch) return true;
  const auto seen_there = std::count_if(landmarks.begin(), landmarks.end(), [&](LandmarkId id) {
    const Landmark* landmark = map.landmarks().find(map.landmarks().resolve(id));
    return landmark &&
           std::any_of(landmark->observations.begin(), landmark->observations.end(),
                       [&](const Observation& o) { return map.stretch_of(o.keyframe) == stretch; });
  });
  return seen_there >= stretch_tie;
}

}  // namespace

KeyframeId Map::stretch_of(KeyframeId id) const {
  if (const Keyframe* keyframe = keyframes_.find(id)) return keyframe->stretch;
  const RetiredKeyframe* retired = retired_.find(id);
  return retired ? retired->stretch : KeyframeId{};
}

void Map::cut_into_stretches(double max_way_m) {
  KeyframeId stretch;
  std::optional<Eigen::Vector3d> last;
  double way_m = 0;
  for (std::uint32_t index = 0; index < retired_.index_bound(); ++index) {
    const KeyframeId id = retired_.at_index(index);
    if (!id.valid()) continue;
    if (Keyframe* keyframe = keyframes_.edit(id)) {
      const Eigen::Vector3d at = keyframe->world_from_camera.translation();
      way_m += last ? (at - *last).norm() : 0;
      last = at;
    }
    if (!stretch.valid() || way_m > max_way_m) {
      stretch = id;
      way_m = 0;
    }
    if (Keyframe* keyframe = keyframes_.edit(id))
      keyframe->stretch = stretch;
    else
      retired_.edit(id)->stretch = stretch;
  }
}

std::optional<Se3> world_from_stretch(const Map& map, KeyframeId stretch) {
  return map.resolve({stretch, Se3{}});
}

KeyframeId stretch_going_on(const Map& map, const Se3& world_from_camera,
                            std::span<const LandmarkId> landmarks, const std::optional<TrackedLink>& link,
                            double max_way_m) {
  const KeyframeId newest = map.keyframes().last();
  if (!newest.valid()) return {};
  const KeyframeId stretch = map.stretch_of(newest);
  if (!tied(map, stretch, landmarks, link)) return {};
  return way_of(map, stretch, world_from_camera) <= max_way_m ? stretch : KeyframeId{};
}

}  // namespace vsgraphs
