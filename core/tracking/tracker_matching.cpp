// The part of the tracker that finds correspondences: with the last frame, then with the local map.
#include <algorithm>

#include "core/tracking/plane_alignment.h"
#include "core/tracking/tracker.h"

namespace vsgraphs {

// If the last frame has become a keyframe meanwhile, its features have landmarks that the frame did not know.
void Tracker::adopt_landmarks_of_own_keyframe(const Map& map) {
  const std::uint32_t bound = map.keyframes().index_bound();
  for (std::uint32_t back = 1; back <= std::min<std::uint32_t>(bound, 4); ++back) {
    const Keyframe* keyframe = map.keyframes().find(map.keyframes().at_index(bound - back));
    if (keyframe && keyframe->frame_index == last_->index) {
      last_->landmarks = keyframe->landmarks;
      return;
    }
  }
  for (LandmarkId& id : last_->landmarks) {
    if (id.valid()) id = map.landmarks().resolve(id);
  }
}

// A search that is too narrow for the step finds coincidences, so a poor result is not the end: wider searches and
// matching without prediction are tried, and the pose that explains most matches wins.
std::optional<FramePose> Tracker::match_recent(const Map& map, bool& guessed, TraceSink* trace) {
  constexpr int plenty = 50;
  std::optional<FramePose> best;
  FrameMatches best_matches;
  const auto keep_if_better = [&](const std::optional<FramePose>& pose, bool guess) {
    if (!pose || (best && best->inliers >= pose->inliers)) return;
    best = pose;
    best_matches = matches_;
    guessed = guess;
  };
  {
    const Span span(trace, "match_motion");
    for (const double widening : {1.0, 2.5}) {
      const double share =
          match_last_frame(map, predicted_, widening * options_.search_radius_px, keep_if_better);
      if (best && best->inliers >= plenty && share >= 0.6) break;
    }
  }
  if (!best || best->inliers < plenty) {
    const Span span(trace, "recover");
    auto found =
        recovery_.from_recent(map, *now_.features, now_.index,
                              {*last_->features, last_->landmarks, *last_world_}, last_->pose.keyframe);
    if (found) {
      matches_ = std::move(found->matches);
      keep_if_better(found->pose, true);
    }
  }
  matches_ = std::move(best_matches);
  return best;
}

// Returns the share of the matches that the pose found explains.
double Tracker::match_last_frame(
    const Map& map, const Se3& predicted, double radius_px,
    const std::function<void(const std::optional<FramePose>&, bool)>& found_pose) {
  constexpr int enough_landmarks = 150;
  matches_.reset(now_.features->size());
  match_points_of_last_frame(map, predicted, radius_px, true);
  if (matches_.size() < enough_landmarks) match_points_of_last_frame(map, predicted, radius_px, false);
  if (matches_.size() < options_.min_inliers) return 0;
  const int found = matches_.size();
  const FramePose pose = solve_frame_pose(camera_, pyramid_, *now_.features, predicted, matches_);
  // A pose that most matches contradict is a coincidence.
  if (!pose.trustworthy || pose.inliers < options_.min_inliers || 4 * pose.inliers < found) return 0;
  found_pose(pose, false);
  return static_cast<double>(pose.inliers) / found;
}

// Projects either the last frame's landmarks or its bare depth readings, and matches them.
void Tracker::match_points_of_last_frame(const Map& map, const Se3& predicted, double radius_px,
                                         bool landmarks) {
  const Se3 world_from_last = *map.resolve(last_->pose);
  const Se3 camera_from_world = predicted.inverse();
  projections_.clear();
  views_.clear();
  for (int i = 0; i < last_->features->size(); ++i) {
    const Feature& feature = (*last_->features)[i];
    LandmarkView view;
    const Landmark* landmark = map.landmarks().find(last_->landmarks[static_cast<std::size_t>(i)]);
    if (landmarks != (landmark != nullptr)) continue;
    if (landmark) {
      view.id = last_->landmarks[static_cast<std::size_t>(i)];
      view.point_in_world = landmark->point_in_world;
    } else if (feature.has_depth()) {
      view.point_in_world = world_from_last * camera_.unproject(feature.u, feature.v, feature.depth_m);
    } else {
      continue;
    }
    const Eigen::Vector3d p = camera_from_world * view.point_in_world;
    if (p.z() < 0.05) continue;
    const Eigen::Vector2d pixel = camera_.project(p);
    if (!camera_.contains(pixel.x(), pixel.y())) continue;
    view.projection.u = static_cast<float>(pixel.x());
    view.projection.v = static_cast<float>(pixel.y());
    view.projection.radius_px = static_cast<float>(radius_px * pyramid_.scale(feature.level));
    view.projection.min_level = std::max(0, feature.level - 1);
    view.projection.max_level = std::min(pyramid_.levels - 1, feature.level + 1);
    view.projection.descriptor = &last_->features->descriptor(i);
    view.projection.angle_rad = feature.angle_rad;
    view.projection.has_angle = true;
    views_.push_back(view);
    projections_.push_back(view.projection);
  }
  MatchOptions options;
  options.check_rotation = true;
  const std::vector<int> found = match_projected(projections_, *now_.features, options, matches_.taken());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0) matches_.add({found[i], views_[i].id, views_[i].point_in_world});
  }
}

std::optional<FramePose> Tracker::refine_on_local_map(const Map& map, const FramePose& guess, KeyframeId near,
                                                      double radius_px) {
  local_map_.select(map, matched_landmarks(), near, options_.local_keyframes);
  match_local_map(map, guess.world_from_camera, radius_px);
  const auto landmarks = matched_landmarks().size();
  // The map is the better reference; the last frame's own readings only carry where the map is thin.
  if (static_cast<int>(landmarks) >= 2 * options_.min_inliers) matches_.keep_landmarks_only();
  const int before = matches_.size();
  constexpr double plane_gate_m = 0.06;
  const FramePose pose = solve_frame_pose(
      camera_, pyramid_, *now_.features, guess.world_from_camera, matches_,
      rows_on_planes(map, surface_now(), guess.world_from_camera, plane_gate_m, camera_.depth_noise));
  if (!pose.trustworthy || pose.inliers < options_.min_inliers || 4 * pose.inliers < before)
    return std::nullopt;
  return pose;
}

void Tracker::match_local_map(const Map& map, const Se3& world_from_camera, double radius_px) {
  project_local_map(map, world_from_camera, radius_px);
  MatchOptions options;
  options.ratio = 0.8;
  const std::vector<int> found = match_projected(projections_, *now_.features, options, matches_.taken());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0) matches_.add({found[i], views_[i].id, views_[i].point_in_world});
  }
}

// Projects the local map's landmarks that are not matched yet; counts all that should be visible as such.
void Tracker::project_local_map(const Map& map, const Se3& world_from_camera, double radius_px) {
  const Se3 camera_from_world = world_from_camera.inverse();
  std::vector<LandmarkId> matched = matched_landmarks();
  std::sort(matched.begin(), matched.end());
  projections_.clear();
  views_.clear();
  visible_now_.clear();
  for (const LandmarkId id : local_map_.landmarks()) {
    LandmarkView view;
    if (!project_landmark(camera_, pyramid_, camera_from_world, id, *map.landmarks().find(id), radius_px,
                          view)) {
      continue;
    }
    visible_now_.push_back(id);
    if (std::binary_search(matched.begin(), matched.end(), id)) continue;
    views_.push_back(view);
    projections_.push_back(view.projection);
  }
}

std::vector<LandmarkId> Tracker::matched_landmarks() const {
  std::vector<LandmarkId> ids;
  ids.reserve(matches_.all().size());
  for (const Correspondence& c : matches_.all()) {
    if (c.landmark.valid()) ids.push_back(c.landmark);
  }
  return ids;
}

}  // namespace vsgraphs
