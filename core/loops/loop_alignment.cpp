#include "core/loops/loop_alignment.h"

#include <algorithm>

#include "core/matching/frame_pose.h"
#include "core/matching/local_map.h"
#include "core/vision/matching.h"

namespace vsgraphs {

namespace {

constexpr double search_radius_px = 8.0;
// How far a neighbour may be off where the keyframe's correction puts it: local maps are stiffer than this.
constexpr double neighbour_slack_m = 0.15, neighbour_slack_rad = 0.05;

}  // namespace

MappedPlace place_around(const Map& map, KeyframeId centre, int max_keyframes) {
  constexpr int min_shared = 15;
  MappedPlace place{centre, {centre}};
  // Where landmarks are rare the link may be all that ties it to its neighbour.
  if (const auto link = map.living_link(centre); link && max_keyframes > 1)
    place.keyframes.push_back(link->to);
  for (const auto& [id, shared] : map.covisible(centre, min_shared)) {
    if (static_cast<int>(place.keyframes.size()) >= max_keyframes) break;
    if (std::find(place.keyframes.begin(), place.keyframes.end(), id) == place.keyframes.end())
      place.keyframes.push_back(id);
  }
  return place;
}

std::vector<LandmarkId> landmarks_of(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::vector<std::uint8_t> seen(map.landmarks().index_bound(), 0);
  std::vector<LandmarkId> landmarks;
  for (const KeyframeId id : keyframes) {
    for (const LandmarkId landmark : map.keyframes().find(id)->landmarks) {
      if (!landmark.valid() || seen[landmark.index]++) continue;
      landmarks.push_back(landmark);
    }
  }
  return landmarks;
}

std::optional<LoopAlignment> LoopAligner::align(const Map& map, KeyframeId keyframe, const MappedPlace& place,
                                                Rng rng) const {
  const Keyframe& now = *map.keyframes().find(keyframe);
  const Keyframe& then = *map.keyframes().find(place.centre);
  const auto rough = by_descriptors_.align(map, posed_view(then), *now.features, options_.min_aligned, rng);
  if (!rough) return std::nullopt;
  auto found =
      search_around(map, keyframe, rough->pose.world_from_camera, landmarks_of(map, place.keyframes));
  if (found && static_cast<int>(found->sights.size()) < options_.min_inliers) found.reset();
  return found;
}

std::optional<LoopAlignment> LoopAligner::search_around(const Map& map, KeyframeId id, const Se3& start,
                                                        const std::vector<LandmarkId>& landmarks) const {
  const FeatureSet& features = *map.keyframes().find(id)->features;
  const Se3 camera_from_world = start.inverse();
  std::vector<LandmarkView> views;
  std::vector<ProjectedPoint> projections;
  for (const LandmarkId landmark : landmarks) {
    LandmarkView view;
    if (!project_landmark(camera_, pyramid_, camera_from_world, landmark, *map.landmarks().find(landmark),
                          search_radius_px, view))
      continue;
    views.push_back(view);
    projections.push_back(view.projection);
  }
  MatchOptions matching;
  matching.max_distance = 64;
  const std::vector<int> found = match_projected(projections, features, matching);
  FrameMatches matches;
  matches.reset(features.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0) matches.add({found[i], views[i].id, views[i].point_in_world});
  }
  const FramePose pose = solve_frame_pose(camera_, pyramid_, features, start, matches);
  if (!pose.trustworthy || pose.inliers < options_.min_neighbour_inliers) return std::nullopt;
  LoopAlignment alignment{id, pose.world_from_camera, pose.information, {}};
  for (const Correspondence& c : matches.all()) alignment.sights.emplace_back(c.feature, c.landmark);
  return alignment;
}

std::vector<KeyframeId> LoopAligner::supporters(const Map& map, const LoopAlignment& alignment,
                                                const MappedPlace& place,
                                                const std::vector<KeyframeId>& neighbours) const {
  const std::vector<LandmarkId> landmarks = landmarks_of(map, place.keyframes);
  const Se3 correction =
      alignment.world_from_camera * map.keyframes().find(alignment.keyframe)->world_from_camera.inverse();
  std::vector<KeyframeId> supporting;
  for (const KeyframeId neighbour : neighbours) {
    if (neighbour == alignment.keyframe) continue;
    const Se3 moved = correction * map.keyframes().find(neighbour)->world_from_camera;
    const auto seen = search_around(map, neighbour, moved, landmarks);
    if (!seen) continue;
    const Vector6d off = (moved.inverse() * seen->world_from_camera).log();
    if (off.head<3>().norm() < neighbour_slack_m && off.tail<3>().norm() < neighbour_slack_rad)
      supporting.push_back(neighbour);
  }
  return supporting;
}

}  // namespace vsgraphs
