#include "core/tracking/last_frame_matcher.h"

#include <algorithm>
#include <utility>

#include "core/vision/matching.h"

namespace vsgraphs {

// A search that is too narrow for the step finds coincidences, so a poor result is not the end: wider searches and
// matching without prediction are tried, and the pose that explains most matches wins.
std::optional<FirstPose> LastFrameMatcher::match(const FrameStep& step, TraceSink* trace) {
  constexpr int plenty = 50;
  std::optional<FirstPose> best;
  const auto keep_if_better = [&best](std::optional<MatchedPose> found, bool guessed) {
    if (!found || (best && best->found.pose.inliers >= found->pose.inliers)) return;
    best = FirstPose{std::move(*found), guessed};
  };
  {
    const Span span(trace, "match_motion");
    for (const double widening : {1.0, 2.5}) {
      Search around = search(step, widening * options_.search_radius_px);
      keep_if_better(std::move(around.found), false);
      if (best && best->found.pose.inliers >= plenty && around.explained >= 0.6) break;
    }
  }
  if (!best || best->found.pose.inliers < plenty) {
    const Span span(trace, "recover");
    const FrameState& last = step.last.state();
    keep_if_better(recovery_.from_recent(step.map, *step.now.features, step.now.index,
                                         {*last.features, last.landmarks, step.last.world_from_camera()},
                                         last.pose.keyframe),
                   true);
  }
  return best;
}

LastFrameMatcher::Search LastFrameMatcher::search(const FrameStep& step, double radius_px) {
  constexpr int enough_landmarks = 150;
  const FeatureSet& features = *step.now.features;
  MatchedPose found;
  found.matches.reset(features.size());
  add_matches(step, radius_px, true, found.matches);
  if (found.matches.size() < enough_landmarks) add_matches(step, radius_px, false, found.matches);
  const int matched = found.matches.size();
  if (matched < options_.min_inliers) return {};
  found.pose = solve_frame_pose(camera_, pyramid_, features, step.predicted, found.matches);
  // A pose that most matches contradict is a coincidence.
  const int inliers = found.pose.inliers;
  if (!found.pose.trustworthy || inliers < options_.min_inliers || 4 * inliers < matched) return {};
  return {std::move(found), static_cast<double>(inliers) / matched};
}

// Either the last frame's landmarks or its bare depth readings.
void LastFrameMatcher::add_matches(const FrameStep& step, double radius_px, bool landmarks,
                                   FrameMatches& matches) {
  const Se3 camera_from_world = step.predicted.inverse();
  const int count = step.last.state().features->size();
  views_.clear();
  projections_.clear();
  for (int i = 0; i < count; ++i) {
    LandmarkView view;
    if (!project(step, camera_from_world, i, landmarks, radius_px, view)) continue;
    views_.push_back(view);
    projections_.push_back(view.projection);
  }
  MatchOptions options;
  options.check_rotation = true;
  const std::vector<int> found = match_projected(projections_, *step.now.features, options, matches.taken());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0) matches.add({found[i], views_[i].id, views_[i].point_in_world});
  }
}

bool LastFrameMatcher::project(const FrameStep& step, const Se3& camera_from_world, int index, bool landmarks,
                               double radius_px, LandmarkView& view) const {
  const FrameState& last = step.last.state();
  const Feature& feature = (*last.features)[index];
  const LandmarkId id = last.landmarks[static_cast<std::size_t>(index)];
  const Landmark* landmark = step.map.landmarks().find(id);
  if (landmarks != (landmark != nullptr)) return false;
  if (landmark) {
    view.id = id;
    view.point_in_world = landmark->point_in_world;
  } else if (feature.has_depth()) {
    view.point_in_world =
        step.last.world_from_camera() * camera_.unproject(feature.u, feature.v, feature.depth_m);
  } else {
    return false;
  }
  const Eigen::Vector3d p = camera_from_world * view.point_in_world;
  if (p.z() < 0.05) return false;
  const Eigen::Vector2d pixel = camera_.project(p);
  if (!camera_.contains(pixel.x(), pixel.y())) return false;
  view.projection.u = static_cast<float>(pixel.x());
  view.projection.v = static_cast<float>(pixel.y());
  view.projection.radius_px = static_cast<float>(radius_px * pyramid_.scale(feature.level));
  view.projection.min_level = std::max(0, feature.level - 1);
  view.projection.max_level = std::min(pyramid_.levels - 1, feature.level + 1);
  view.projection.descriptor = &last.features->descriptor(index);
  view.projection.angle_rad = feature.angle_rad;
  view.projection.has_angle = true;
  return true;
}

}  // namespace vsgraphs
