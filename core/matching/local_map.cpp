#include "core/matching/local_map.h"

#include <algorithm>

namespace vsgraphs {

bool project_landmark(const Camera& camera, const ScalePyramid& pyramid, const Se3& camera_from_world,
                      LandmarkId id, const Landmark& landmark, double radius_px, LandmarkView& view) {
  const Eigen::Vector3d p = camera_from_world * landmark.point_in_world;
  if (p.z() < 0.05) return false;
  const Eigen::Vector2d pixel = camera.project(p);
  if (!camera.contains(pixel.x(), pixel.y())) return false;

  const Appearance& appearance = landmark.appearance;
  const double distance = p.norm();
  // The angle between rays is the same in both frames, so the stored direction is turned, not the point.
  const double cosine =
      p.dot(camera_from_world.rotation() * appearance.view_direction.cast<double>()) / distance;
  if (cosine < 0.5) return false;
  const int level =
      pyramid.predict_level(distance, appearance.reference_distance_m, appearance.reference_level);
  // More than the pyramid can bridge: the patch would not look the same.
  const double ratio = distance / appearance.reference_distance_m;
  if (ratio > 1.2 * pyramid.scale(appearance.reference_level) ||
      ratio * 1.2 < pyramid.scale(appearance.reference_level) / pyramid.scale(pyramid.levels - 1)) {
    return false;
  }

  view.id = id;
  view.point_in_world = landmark.point_in_world;
  view.projection = ProjectedPoint{};
  view.projection.u = static_cast<float>(pixel.x());
  view.projection.v = static_cast<float>(pixel.y());
  view.projection.radius_px = static_cast<float>(radius_px * pyramid.scale(level));
  view.projection.min_level = std::max(0, level - 1);
  view.projection.max_level = std::min(pyramid.levels - 1, level + 1);
  view.projection.descriptor = &appearance.descriptor;
  return true;
}

void LocalMap::select(const Map& map, std::span<const LandmarkId> seen, KeyframeId fallback,
                      int max_keyframes) {
  keyframes_.clear();
  vote(map, seen);
  std::sort(voters_.begin(), voters_.end(), [this](KeyframeId a, KeyframeId b) {
    return votes_[a.index] != votes_[b.index] ? votes_[a.index] > votes_[b.index] : a < b;
  });
  if (voters_.empty() && map.keyframes().contains(fallback)) voters_.push_back(fallback);
  reference_ = voters_.empty() ? KeyframeId{} : voters_.front();
  const auto limit = static_cast<std::size_t>(max_keyframes);
  keyframes_.assign(voters_.begin(),
                    voters_.begin() + static_cast<std::ptrdiff_t>(std::min(limit, voters_.size())));
  if (keyframes_.size() < limit) add_neighbours(map, limit);
  gather_landmarks(map);
}

void LocalMap::vote(const Map& map, std::span<const LandmarkId> seen) {
  votes_.assign(map.keyframes().index_bound(), 0);
  voters_.clear();
  for (const LandmarkId id : seen) {
    const Landmark* landmark = map.landmarks().find(id);
    if (!landmark) continue;
    for (const Observation& observation : landmark->observations) {
      if (votes_[observation.keyframe.index]++ == 0) voters_.push_back(observation.keyframe);
    }
  }
}

bool LocalMap::chosen(KeyframeId id) const {
  return std::find(keyframes_.begin(), keyframes_.end(), id) != keyframes_.end();
}

void LocalMap::add_neighbours(const Map& map, std::size_t max_keyframes) {
  constexpr int min_shared = 30, per_keyframe = 3;
  const std::size_t strongest = std::min<std::size_t>(keyframes_.size(), 3);
  for (std::size_t i = 0; i < strongest; ++i) {
    int added = 0;
    for (const auto& [neighbour, shared] : map.covisible(keyframes_[i], min_shared)) {
      if (keyframes_.size() >= max_keyframes || added == per_keyframe) break;
      if (chosen(neighbour)) continue;
      keyframes_.push_back(neighbour);
      ++added;
    }
  }
}

void LocalMap::gather_landmarks(const Map& map) {
  landmarks_.clear();
  gathered_.resize(map.landmarks().index_bound(), 0);
  ++pass_;
  for (const KeyframeId id : keyframes_) {
    const Keyframe* keyframe = map.keyframes().find(id);
    if (!keyframe) continue;
    for (const LandmarkId landmark : keyframe->landmarks) {
      if (!landmark.valid() || gathered_[landmark.index] == pass_) continue;
      gathered_[landmark.index] = pass_;
      landmarks_.push_back(landmark);
    }
  }
}

}  // namespace vsgraphs
