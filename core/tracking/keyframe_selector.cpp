#include "core/tracking/keyframe_selector.h"

#include <limits>
#include <utility>

namespace vsgraphs {

namespace {

int established_landmarks(const Map& map, const Keyframe& keyframe) {
  const std::size_t established = map.keyframes().size() > 2 ? 3 : 1;
  int count = 0;
  for (const LandmarkId id : keyframe.landmarks) {
    const Landmark* landmark = map.landmarks().find(id);
    if (landmark && landmark->observations.size() >= established) ++count;
  }
  return count;
}

}  // namespace

bool KeyframeSelector::wanted(const Map& map, const FrameState& now, const Se3& world_from_camera,
                              int backlog) const {
  return keyframe_wanted(options_, gather(map, now, world_from_camera, backlog));
}

KeyframeEvidence KeyframeSelector::gather(const Map& map, const FrameState& now, const Se3& world_from_camera,
                                          int backlog) const {
  KeyframeEvidence e;
  e.backlog = backlog;
  e.seconds_since_last = now.timestamp_s - last_s_;
  const auto last = last_pose_ ? map.resolve(*last_pose_) : std::nullopt;
  if (last) {
    const Se3 step = last->inverse() * world_from_camera;
    e.translation_m = step.translation().norm();
    e.rotation_rad = rotation_angle(step.rotation());
  } else {  // it is in another map
    e.translation_m = std::numeric_limits<double>::infinity();
  }
  e.held_by_surfaces = now.surface_reference.valid();
  e.reference_landmarks = established_landmarks(map, *map.keyframes().find(now.pose.keyframe));
  for (std::size_t i = 0; i < now.landmarks.size(); ++i) {
    const bool tracked = now.landmarks[i].valid();
    const bool depth = (*now.features)[static_cast<int>(i)].has_depth();
    e.tracked += tracked;
    e.tracked_close += tracked && depth;
    e.untracked_close += !tracked && depth;
  }
  return e;
}

std::shared_ptr<const KeyframeRequest> KeyframeSelector::request(const FrameState& now, bool first,
                                                                 std::vector<Sighting> sightings) {
  auto request = std::make_shared<KeyframeRequest>();
  request->frame_index = now.index;
  request->timestamp_s = now.timestamp_s;
  request->first = first;
  request->pose = now.pose;
  request->features = now.features;
  request->surface = now.surface;
  request->tracked_link = now.tracked_link;
  request->landmarks = now.landmarks;
  request->sightings = std::move(sightings);
  last_pose_ = now.pose;
  last_s_ = now.timestamp_s;
  return request;
}

void KeyframeSelector::name_first(KeyframeId id) {
  if (last_pose_ && !last_pose_->keyframe.valid()) last_pose_->keyframe = id;
}

}  // namespace vsgraphs
