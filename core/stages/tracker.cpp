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

}  // namespace vsgraphs
