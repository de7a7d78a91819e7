// The part of the tracker that turns a pose into an answer: where the frame hangs, whether it is kept, what was seen.
#include <algorithm>
#include <limits>

#include "core/tracking/tracker.h"

namespace vsgraphs {

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

// The pose was measured from the last frame on; `near`: the keyframe that one hangs on.
TrackedFrame Tracker::finish(const Map& map, const FramePose& pose, KeyframeId near, int backlog) {
  note_sightings();
  const KeyframeId anchor = choose_anchor(near);
  now_.pose = {anchor, map.keyframes().find(anchor)->world_from_camera.inverse() * pose.world_from_camera};
  const double seconds = now_.timestamp_s - last_->timestamp_s;
  const auto landmarks =
      std::count_if(now_.landmarks.begin(), now_.landmarks.end(), [](LandmarkId id) { return id.valid(); });
  if (landmarks < options_.few_inliers) {
    // What only the prediction held is passed on as weakly as it was known.
    now_.tracked_link =
        TrackedLink{anchor, now_.pose.keyframe_from_camera,
                    pose.information + motion_prior(pose.world_from_camera, seconds).information};
  }
  motion_.update(*last_world_, pose.world_from_camera, seconds, pose.measured);
  return answer(map, pose, pose.degenerate ? TrackStatus::coasting : TrackStatus::ok, false, backlog);
}

// Found again after a loss. In a dormant map a keyframe is asked for in any case: it is what makes that map the active one.
TrackedFrame Tracker::finish_relocalised(const KnownMaps& known, const Found& found, int backlog) {
  const Map& map = *found.in->map;
  note_sightings();
  now_.pose.keyframe = choose_anchor(local_map_.reference());
  const Se3& world_from_anchor = map.keyframes().find(now_.pose.keyframe)->world_from_camera;
  now_.pose.keyframe_from_camera = world_from_anchor.inverse() * found.pose.world_from_camera;
  const auto landmarks =
      std::count_if(now_.landmarks.begin(), now_.landmarks.end(), [](LandmarkId id) { return id.valid(); });
  if (landmarks < options_.few_inliers)
    now_.tracked_link =
        TrackedLink{now_.pose.keyframe, now_.pose.keyframe_from_camera, found.pose.information};
  motion_.forget();
  return answer(map, found.pose, TrackStatus::relocalised, found.in != &known.active, backlog);
}

TrackedFrame Tracker::answer(const Map& map, const FramePose& pose, TrackStatus status, bool always_keep,
                             int backlog) {
  lost_ = false;
  searching_since_s_.reset();
  last_measured_s_ = now_.timestamp_s;
  unmeasured_frames_ = 0;
  TrackedFrame result = report(status, pose.world_from_camera);
  result.matches = pose.inliers;
  if (always_keep ||
      keyframe_wanted(options_.keyframe, gather_evidence(map, pose.world_from_camera, backlog)))
    result.keyframe_request = make_request(now_.pose, false);
  last_ = now_;
  return result;
}

// The keyframe the frame hangs on: the one that held its pose. A handful of votes is no hold, and may come from a
// place that only looks alike.
KeyframeId Tracker::choose_anchor(KeyframeId near) const {
  constexpr int enough_votes = 15;
  if (now_.surface_reference.valid()) return now_.surface_reference;
  if (local_map_.reference_votes() >= enough_votes) return local_map_.reference();
  return near;
}

bool Tracker::loses_track() const {
  return now_.timestamp_s - last_measured_s_ > options_.coast_s && unmeasured_frames_ > options_.coast_frames;
}

// The last measured frame stays the one to match against; only the prediction moves on.
TrackedFrame Tracker::coast(const Map& map) {
  const auto anchor = *map.reanchor(last_->pose);
  now_.pose = {anchor.keyframe,
               map.keyframes().find(anchor.keyframe)->world_from_camera.inverse() * predicted_};
  return report(TrackStatus::coasting, predicted_);
}

// What was seen without being recognised counts, not time in the dark.
TrackedFrame Tracker::stay_lost() {
  lost_ = true;
  motion_.forget();
  if (enough_to_start()) {
    if (!searching_since_s_) searching_since_s_ = now_.timestamp_s;
    if (now_.timestamp_s - *searching_since_s_ >= options_.new_map_after_s) return start();
  }
  return report(TrackStatus::lost, Se3{});
}

KeyframeEvidence Tracker::gather_evidence(const Map& map, const Se3& world_from_camera, int backlog) const {
  KeyframeEvidence e;
  e.backlog = backlog;
  e.seconds_since_last = now_.timestamp_s - last_keyframe_s_;
  const auto last = last_keyframe_pose_ ? map.resolve(*last_keyframe_pose_) : std::nullopt;
  if (last) {
    const Se3 step = last->inverse() * world_from_camera;
    e.translation_m = step.translation().norm();
    e.rotation_rad = rotation_angle(step.rotation());
  } else {  // it is in another map
    e.translation_m = std::numeric_limits<double>::infinity();
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
