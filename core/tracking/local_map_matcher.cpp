#include "core/tracking/local_map_matcher.h"

#include <algorithm>
#include <utility>

#include "core/tracking/plane_alignment.h"

namespace vsgraphs {

std::optional<MatchedPose> LocalMapMatcher::refine(const Map& map, const FrameState& now, MatchedPose guess,
                                                   KeyframeId near, double radius_px) {
  constexpr double plane_gate_m = 0.06;
  const Se3& start = guess.pose.world_from_camera;
  FrameMatches& matches = guess.matches;
  local_map_.select(map, matches.landmarks(), near, options_.local_keyframes);
  add_matches(map, now, start, radius_px, matches);
  // The map is the better reference; the last frame's own readings only carry where the map is thin.
  if (static_cast<int>(matches.landmarks().size()) >= 2 * options_.min_inliers) matches.keep_landmarks_only();
  const int before = matches.size();
  const FramePose pose =
      solve_frame_pose(camera_, pyramid_, *now.features, start, matches,
                       rows_on_planes(map, *now.surface, start, plane_gate_m, camera_.depth_noise));
  if (!pose.trustworthy || pose.inliers < options_.min_inliers || 4 * pose.inliers < before)
    return std::nullopt;
  return MatchedPose{pose, std::move(matches), {}};
}

FrameMatches LocalMapMatcher::match_around(const Map& map, const FrameState& now, KeyframeId near,
                                           const Se3& world_from_camera) {
  FrameMatches matches;
  matches.reset(now.features->size());
  local_map_.select(map, {}, near, options_.local_keyframes);
  add_matches(map, now, world_from_camera, options_.local_search_radius_px, matches);
  return matches;
}

void LocalMapMatcher::add_matches(const Map& map, const FrameState& now, const Se3& world_from_camera,
                                  double radius_px, FrameMatches& matches) {
  project(map, world_from_camera, radius_px, matches);
  MatchOptions options;
  options.ratio = 0.8;
  const std::vector<int> found = match_projected(projections_, *now.features, options, matches.taken());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0) matches.add({found[i], views_[i].id, views_[i].point_in_world});
  }
}

void LocalMapMatcher::project(const Map& map, const Se3& world_from_camera, double radius_px,
                              const FrameMatches& matches) {
  const Se3 camera_from_world = world_from_camera.inverse();
  std::vector<LandmarkId> matched = matches.landmarks();
  std::sort(matched.begin(), matched.end());
  projections_.clear();
  views_.clear();
  expected_.clear();
  for (const LandmarkId id : local_map_.landmarks()) {
    LandmarkView view;
    const Landmark& landmark = *map.landmarks().find(id);
    if (!project_landmark(camera_, pyramid_, camera_from_world, id, landmark, radius_px, view)) continue;
    expected_.push_back(id);
    if (std::binary_search(matched.begin(), matched.end(), id)) continue;
    views_.push_back(view);
    projections_.push_back(view.projection);
  }
}

}  // namespace vsgraphs
