#include "core/stages/tracker.h"

#include <algorithm>
#include <cmath>

#include "core/vision/grey.h"

namespace vsgraphs {

const char* to_string(TrackStatus status) {
  switch (status) {
    case TrackStatus::waiting:
      return "waiting";
    case TrackStatus::initialised:
      return "initialised";
    case TrackStatus::ok:
      return "ok";
    case TrackStatus::coasting:
      return "coasting";
    case TrackStatus::lost:
      return "lost";
    case TrackStatus::relocalised:
      return "relocalised";
  }
  return "unknown";
}

Tracker::Tracker(const TrackerOptions& options, const OrbOptions& orb, const Camera& camera,
                 std::uint64_t seed)
    : options_(options),
      camera_(camera),
      pyramid_{orb.levels, orb.scale_factor},
      extractor_(orb, camera),
      aligner_(camera),
      recovery_(options.recovery, camera, pyramid_, seed) {}

TrackedFrame Tracker::track(const RgbdFrame& frame, const Snapshot& snapshot, int backlog, TraceSink* trace) {
  extract(frame, trace);
  if (!last_) return start(snapshot);
  const Map& map = *snapshot;
  last_->pose = *map.reanchor(last_->pose);
  const double seconds = now_.timestamp_s - last_->timestamp_s;
  last_world_ = *map.resolve(last_->pose);
  predicted_ = motion_.predict(*last_world_, seconds);
  adopt_landmarks_of_own_keyframe(map);
  visible_now_.clear();

  const bool was_lost = lost_;
  std::optional<FramePose> pose = was_lost ? relocalise(map, seconds, trace) : follow(map, seconds, trace);
  if (!pose) return coast_or_lose(map);
  return finish(snapshot, *pose, was_lost ? TrackStatus::relocalised : TrackStatus::ok, backlog);
}

std::optional<FramePose> Tracker::follow(const Map& map, double seconds, TraceSink* trace) {
  bool guessed = false;  // found without prediction: to be checked against the surfaces
  std::optional<FramePose> pose = match_recent(map, guessed, trace);
  if (pose) {
    const Span span(trace, "match_local_map");
    pose = refine_on_local_map(map, *pose);
  }
  if (pose && guessed && !surfaces_agree(map, *pose)) pose.reset();
  if (pose && !believable(pose->world_from_camera, seconds)) pose.reset();
  if (!pose || pose->inliers < options_.few_inliers) {
    const Span span(trace, "align_surfaces");
    pose = align_surfaces(map, pose, seconds);
  }
  return pose;
}

// Whatever might be the place is tried to the end: the last frame's surroundings first, then what looks most alike.
std::optional<FramePose> Tracker::relocalise(const Map& map, double seconds, TraceSink* trace) {
  const Span span(trace, "relocalise");
  const auto accept = [&](std::optional<FramePose> pose) {
    if (pose) pose = refine_on_local_map(map, *pose);
    const bool good = pose && pose->inliers >= options_.recovery.min_relocalisation_inliers &&
                      surfaces_agree(map, *pose) && believable(pose->world_from_camera, seconds);
    return good ? pose : std::nullopt;
  };
  auto pose = accept(recovery_.from_recent(map, *now_.features, now_.index, *last_->features,
                                           last_->landmarks, *last_world_, last_->pose.keyframe, matches_));
  if (pose) return pose;
  for (const KeyframeId place : recovery_.likely_places(map, *now_.features)) {
    pose = accept(recovery_.from_keyframe(map, place, *now_.features, now_.index, matches_));
    if (pose) return pose;
  }
  return std::nullopt;
}

void Tracker::extract(const RgbdFrame& frame, TraceSink* trace) {
  const Span span(trace, "extract");
  now_ = FrameState{};
  now_.index = frame.index;
  now_.timestamp_s = frame.timestamp_s;
  ImageView<std::uint8_t> grey = frame.grey;
  if (grey.empty()) {
    to_grey(frame.colour, grey_);
    grey = grey_.view();
  }
  now_.features = std::make_shared<const FeatureSet>(extractor_.extract(grey, frame.depth, frame.colour));
  now_.surface = std::make_shared<const DepthGrid>(aligner_.sampler().sample(frame.depth));
  now_.landmarks.assign(static_cast<std::size_t>(now_.features->size()), LandmarkId{});
}

TrackedFrame Tracker::start(const Snapshot& snapshot) {
  const auto with_depth = std::count_if(now_.features->features().begin(), now_.features->features().end(),
                                        [](const Feature& f) { return f.has_depth(); });
  if (with_depth < options_.min_features_to_start) return report(TrackStatus::waiting, Se3{});
  // The request will become the map's first keyframe, and this frame hangs on it.
  now_.pose = {snapshot->keyframes().next_id(), Se3{}};
  last_measured_s_ = now_.timestamp_s;
  TrackedFrame result = report(TrackStatus::initialised, Se3{});
  result.matches = static_cast<int>(with_depth);
  result.keyframe_request = make_request(now_.pose, true);
  last_ = now_;
  return result;
}

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
    keep_if_better(recovery_.from_recent(map, *now_.features, now_.index, *last_->features, last_->landmarks,
                                         *last_world_, last_->pose.keyframe, matches_),
                   true);
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

std::optional<FramePose> Tracker::refine_on_local_map(const Map& map, const FramePose& guess) {
  local_map_.select(map, matched_landmarks(), last_->pose.keyframe, options_.local_keyframes);
  match_local_map(map, guess.world_from_camera);
  const auto landmarks = matched_landmarks().size();
  // The map is the better reference; the last frame's own readings only carry where the map is thin.
  if (static_cast<int>(landmarks) >= 2 * options_.min_inliers) matches_.keep_landmarks_only();
  const int before = matches_.size();
  const FramePose pose =
      solve_frame_pose(camera_, pyramid_, *now_.features, guess.world_from_camera, matches_);
  if (!pose.trustworthy || pose.inliers < options_.min_inliers || 4 * pose.inliers < before)
    return std::nullopt;
  return pose;
}

void Tracker::match_local_map(const Map& map, const Se3& world_from_camera) {
  project_local_map(map, world_from_camera);
  MatchOptions options;
  options.ratio = 0.8;
  const std::vector<int> found = match_projected(projections_, *now_.features, options, matches_.taken());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0) matches_.add({found[i], views_[i].id, views_[i].point_in_world});
  }
}

// Projects the local map's landmarks that are not matched yet; counts all that should be visible as such.
void Tracker::project_local_map(const Map& map, const Se3& world_from_camera) {
  const Se3 camera_from_world = world_from_camera.inverse();
  std::vector<LandmarkId> matched = matched_landmarks();
  std::sort(matched.begin(), matched.end());
  projections_.clear();
  views_.clear();
  visible_now_.clear();
  for (const LandmarkId id : local_map_.landmarks()) {
    LandmarkView view;
    if (!project_landmark(camera_, pyramid_, camera_from_world, id, *map.landmarks().find(id),
                          options_.local_search_radius_px, view)) {
      continue;
    }
    visible_now_.push_back(id);
    if (std::binary_search(matched.begin(), matched.end(), id)) continue;
    views_.push_back(view);
    projections_.push_back(view.projection);
  }
}

// A camera in a hand or on a robot cannot go faster than so much, nor change its velocity at once: where the motion
// is known, a pose far from the prediction is a place that looks alike.
bool Tracker::believable(const Se3& world_from_now, double seconds) const {
  if (!world_from_now.finite()) return false;
  constexpr double slack_m = 0.1, slack_rad = 0.15;
  const Se3 step = last_world_->inverse() * world_from_now;
  if (step.translation().norm() > options_.max_speed_m_per_s * seconds + slack_m ||
      rotation_angle(step.rotation()) > options_.max_turn_rad_per_s * seconds + slack_rad) {
    return false;
  }
  if (lost_ || !motion_.known()) return true;
  const Se3 surprise = predicted_.inverse() * world_from_now;
  return surprise.translation().norm() <= options_.max_velocity_change_m_per_s * seconds + slack_m &&
         rotation_angle(surprise.rotation()) <= options_.max_turn_change_rad_per_s * seconds + slack_rad;
}

void Tracker::note_sightings() {
  for (const Correspondence& c : matches_.all()) {
    if (!c.landmark.valid()) continue;
    now_.landmarks[static_cast<std::size_t>(c.feature)] = c.landmark;
    ++sightings_[c.landmark].found;
  }
  // A frame too dark or too blurred to show anything says nothing against the landmarks.
  if (matches_.size() < options_.min_inliers) return;
  for (const LandmarkId id : visible_now_) ++sightings_[id].visible;
}

TrackedFrame Tracker::finish(const Snapshot& snapshot, const FramePose& pose, TrackStatus status,
                             int backlog) {
  const Map& map = *snapshot;
  note_sightings();
  const KeyframeId anchor = choose_anchor();
  const Se3& world_from_anchor = map.keyframes().find(anchor)->world_from_camera;
  now_.pose = {anchor, world_from_anchor.inverse() * pose.world_from_camera};
  const double seconds = now_.timestamp_s - last_->timestamp_s;
  const auto landmarks =
      std::count_if(now_.landmarks.begin(), now_.landmarks.end(), [](LandmarkId id) { return id.valid(); });
  if (landmarks < options_.few_inliers) {
    // What only the prediction held is passed on as weakly as it was known.
    now_.tracked_link =
        TrackedLink{anchor, now_.pose.keyframe_from_camera,
                    pose.information + motion_prior(pose.world_from_camera, seconds).information};
  }

  if (status == TrackStatus::relocalised) {
    motion_.forget();
  } else {
    motion_.update(*map.resolve(last_->pose), pose.world_from_camera, seconds);
  }
  if (pose.degenerate) status = TrackStatus::coasting;
  lost_ = false;
  last_measured_s_ = now_.timestamp_s;
  unmeasured_frames_ = 0;
  TrackedFrame result = report(status, pose.world_from_camera);
  result.matches = pose.inliers;
  if (keyframe_wanted(options_.keyframe, gather_evidence(map, pose.world_from_camera, backlog))) {
    result.keyframe_request = make_request(now_.pose, false);
  }
  last_ = now_;
  return result;
}

// The keyframe the frame hangs on: the one that held its pose. A handful of votes is no hold, and may come from a
// place that only looks alike.
KeyframeId Tracker::choose_anchor() const {
  constexpr int enough_votes = 15;
  if (now_.surface_reference.valid()) return now_.surface_reference;
  if (local_map_.reference_votes() >= enough_votes) return local_map_.reference();
  return last_->pose.keyframe;
}

TrackedFrame Tracker::coast_or_lose(const Map& map) {
  ++unmeasured_frames_;
  const bool long_ago = now_.timestamp_s - last_measured_s_ > options_.coast_s;
  if (lost_ || (long_ago && unmeasured_frames_ > options_.coast_frames)) {
    lost_ = true;
    motion_.forget();
    return report(TrackStatus::lost, Se3{});
  }
  // The last measured frame stays the one to match against; only the prediction moves on.
  const auto anchor = *map.reanchor(last_->pose);
  now_.pose = {anchor.keyframe,
               map.keyframes().find(anchor.keyframe)->world_from_camera.inverse() * predicted_};
  return report(TrackStatus::coasting, predicted_);
}

std::vector<LandmarkId> Tracker::matched_landmarks() const {
  std::vector<LandmarkId> ids;
  ids.reserve(matches_.all().size());
  for (const Correspondence& c : matches_.all()) {
    if (c.landmark.valid()) ids.push_back(c.landmark);
  }
  return ids;
}

KeyframeEvidence Tracker::gather_evidence(const Map& map, const Se3& world_from_camera, int backlog) const {
  KeyframeEvidence e;
  e.backlog = backlog;
  e.seconds_since_last = now_.timestamp_s - last_keyframe_s_;
  if (const auto last = map.resolve(*last_keyframe_pose_)) {
    const Se3 step = last->inverse() * world_from_camera;
    e.translation_m = step.translation().norm();
    e.rotation_rad = rotation_angle(step.rotation());
  }
  e.held_by_surfaces = now_.surface_reference.valid();
  const Keyframe* reference = map.keyframes().find(now_.pose.keyframe);
  const std::size_t established = map.keyframes().size() > 2 ? 3 : 1;
  for (const LandmarkId id : reference->landmarks) {
    const Landmark* landmark = map.landmarks().find(id);
    if (landmark && landmark->observations.size() >= established) ++e.reference_landmarks;
  }
  for (std::size_t i = 0; i < now_.landmarks.size(); ++i) {
    const bool tracked = now_.landmarks[i].valid();
    const bool depth = (*now_.features)[static_cast<int>(i)].has_depth();
    e.tracked += tracked;
    e.tracked_close += tracked && depth;
    e.untracked_close += !tracked && depth;
  }
  return e;
}

std::shared_ptr<const KeyframeRequest> Tracker::make_request(const AnchoredPose& pose, bool first) {
  auto request = std::make_shared<KeyframeRequest>();
  request->frame_index = now_.index;
  request->timestamp_s = now_.timestamp_s;
  request->first = first;
  request->pose = pose;
  request->features = now_.features;
  request->surface = now_.surface;
  request->tracked_link = now_.tracked_link;
  request->landmarks = now_.landmarks;
  request->sightings.reserve(sightings_.size());
  for (const auto& [id, sighting] : sightings_) {
    request->sightings.push_back({id, sighting.visible, sighting.found});
  }
  std::sort(request->sightings.begin(), request->sightings.end(),
            [](const Sighting& a, const Sighting& b) { return a.landmark < b.landmark; });
  sightings_.clear();
  last_keyframe_pose_ = pose;
  last_keyframe_s_ = now_.timestamp_s;
  return request;
}

TrackedFrame Tracker::report(TrackStatus status, const Se3& world_from_camera) const {
  TrackedFrame result;
  result.index = now_.index;
  result.timestamp_s = now_.timestamp_s;
  result.status = status;
  result.pose = now_.pose;
  result.world_from_camera = world_from_camera;
  return result;
}

}  // namespace vsgraphs
