#include "core/matching/landmark_fusion.h"

#include <algorithm>
#include <cmath>

#include "core/matching/local_map.h"
#include "core/vision/matching.h"

namespace vsgraphs {

namespace {

constexpr double search_radius_px = 4.0;
constexpr int max_distance = 60;  // stricter than tracking: a wrong merge stays

// The feature's own depth, where it has one, must not contradict the landmark's.
bool depth_agrees(const Camera& camera, const Feature& feature, double landmark_depth_m) {
  if (!feature.has_depth()) return true;
  const double tolerance = 4.0 * camera.depth_noise.feature_sigma_m(landmark_depth_m);
  return std::abs(feature.depth_m - landmark_depth_m) < tolerance;
}

struct Sight {
  LandmarkId landmark;
  int feature;
};

// Which of `candidates` the keyframe's features show; `taken` features are passed over.
std::vector<Sight> look_for(const Camera& camera, const ScalePyramid& pyramid, const Map& map,
                            const Keyframe& keyframe, const std::vector<LandmarkId>& candidates,
                            std::span<const std::uint8_t> taken) {
  const Se3 camera_from_world = keyframe.world_from_camera.inverse();
  std::vector<ProjectedPoint> projections;
  std::vector<LandmarkId> ids;
  std::vector<double> depths;
  for (const LandmarkId id : candidates) {
    const Landmark* landmark = map.landmarks().find(id);
    LandmarkView view;
    if (!landmark ||
        !project_landmark(camera, pyramid, camera_from_world, id, *landmark, search_radius_px, view)) {
      continue;
    }
    projections.push_back(view.projection);
    ids.push_back(id);
    depths.push_back((camera_from_world * landmark->point_in_world).z());
  }
  MatchOptions options;
  options.max_distance = max_distance;
  options.ratio = 1.0;
  const std::vector<int> found = match_projected(projections, *keyframe.features, options, taken);
  std::vector<Sight> sights;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0 && depth_agrees(camera, (*keyframe.features)[found[i]], depths[i])) {
      sights.push_back({ids[i], found[i]});
    }
  }
  return sights;
}

bool observes(const Landmark& landmark, KeyframeId keyframe) {
  return std::any_of(landmark.observations.begin(), landmark.observations.end(),
                     [keyframe](const Observation& o) { return o.keyframe == keyframe; });
}

// One point seen twice, not a near and a far one along a ray: as far apart as two readings of one depth may be.
bool same_place(const Camera& camera, const Keyframe& seen_from, const Landmark& a, const Landmark& b) {
  const double depth_m = (seen_from.world_from_camera.inverse() * a.point_in_world).z();
  return (a.point_in_world - b.point_in_world).norm() < 6.0 * camera.depth_noise.feature_sigma_m(depth_m);
}

void merge_or_observe(const Camera& camera, const Sight& sight, KeyframeId keyframe, Draft& draft) {
  const Map& map = draft.map();
  const LandmarkId present =
      map.keyframes().find(keyframe)->landmarks[static_cast<std::size_t>(sight.feature)];
  const Landmark* landmark = map.landmarks().find(sight.landmark);
  if (!landmark || present == sight.landmark || observes(*landmark, keyframe)) return;
  if (!present.valid()) {
    draft.record(AddObservation{sight.landmark, {keyframe, static_cast<std::uint16_t>(sight.feature)}});
    return;
  }
  const Landmark& other = *map.landmarks().find(present);
  if (!same_place(camera, *map.keyframes().find(keyframe), *landmark, other)) return;
  const bool keep_present = other.observations.size() >= landmark->observations.size();
  draft.record(keep_present ? MergeLandmark{sight.landmark, present}
                            : MergeLandmark{present, sight.landmark});
}

}  // namespace

void observe_neighbours_landmarks(const Camera& camera, const ScalePyramid& pyramid, KeyframeId id,
                                  const std::vector<KeyframeId>& neighbours, Draft& draft) {
  const Map& map = draft.map();
  std::vector<std::uint8_t> considered(map.landmarks().index_bound(), 0);
  const Keyframe& keyframe = *map.keyframes().find(id);
  std::vector<std::uint8_t> taken(keyframe.landmarks.size(), 0);
  for (std::size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    taken[i] = keyframe.landmarks[i].valid();
    if (taken[i]) considered[keyframe.landmarks[i].index] = 1;
  }
  std::vector<LandmarkId> candidates;
  for (const KeyframeId neighbour : neighbours) {
    for (const LandmarkId landmark : map.keyframes().find(neighbour)->landmarks) {
      if (!landmark.valid() || considered[landmark.index]) continue;
      considered[landmark.index] = 1;
      candidates.push_back(landmark);
    }
  }
  for (const Sight& sight : look_for(camera, pyramid, map, keyframe, candidates, taken)) {
    draft.record(AddObservation{sight.landmark, {id, static_cast<std::uint16_t>(sight.feature)}});
  }
}

void fuse_into_neighbours(const Camera& camera, const ScalePyramid& pyramid, KeyframeId id,
                          const std::vector<KeyframeId>& neighbours, Draft& draft) {
  for (const KeyframeId neighbour_id : neighbours) {
    std::vector<LandmarkId> candidates;
    for (const LandmarkId landmark : draft.map().keyframes().find(id)->landmarks) {
      if (landmark.valid() && !observes(*draft.map().landmarks().find(landmark), neighbour_id)) {
        candidates.push_back(landmark);
      }
    }
    const Keyframe& neighbour = *draft.map().keyframes().find(neighbour_id);
    for (const Sight& sight : look_for(camera, pyramid, draft.map(), neighbour, candidates, {})) {
      merge_or_observe(camera, sight, neighbour_id, draft);
    }
  }
}

}  // namespace vsgraphs
