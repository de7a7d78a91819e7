#include "core/tracking/tracker.h"

#include <utility>

#include "core/tracking/frame_anchor.h"
#include "core/tracking/motion_prior.h"

namespace vsgraphs {

namespace {

TrackedFrame report(const FrameState& now, TrackStatus status, const Se3& world_from_camera) {
  TrackedFrame result;
  result.index = now.index;
  result.timestamp_s = now.timestamp_s;
  result.status = status;
  result.pose = now.pose;
  result.world_from_camera = world_from_camera;
  return result;
}

}  // namespace

Tracker::Tracker(const TrackerOptions& options, const OrbOptions& orb, const Camera& camera,
                 std::uint64_t seed)
    : options_(options),
      pyramid_{orb.levels, orb.scale_factor},
      aligner_(camera),
      recovery_(options.recovery, camera, pyramid_, seed),
      extractor_(orb, camera),
      last_frame_matcher_(options, camera, pyramid_, recovery_),
      local_map_matcher_(options, camera, pyramid_),
      verifier_(options.recovery, camera, aligner_),
      surfaces_(options, camera, pyramid_, aligner_, local_map_matcher_),
      relocaliser_(options, recovery_, verifier_, local_map_matcher_),
      loss_(options),
      keyframes_(options.keyframe) {}

TrackedFrame Tracker::track(const RgbdFrame& frame, const KnownMaps& known, int backlog, TraceSink* trace) {
  FrameState now = extract(frame, trace);
  if (known.empty() && !last_.exists())
    return enough_to_start(now) ? start(now) : report(now, TrackStatus::waiting, Se3{});
  const KnownMap* last_in = place_last_frame(known);
  if (!last_in) loss_.lose();
  if (loss_.lost()) {
    const auto again = relocalise(known, last_in, now, trace);
    if (!again) return stay_lost(now);
    return resume(*again->in->map, again->found, again->in != &known.active, now, backlog);
  }
  const FrameStep step = step_to(now, *last_in->map);
  const std::optional<MatchedPose> found = follow(step, trace);
  if (found) return go_on(step, *found, now, backlog);
  return loss_.coasts(now.timestamp_s) ? coast(step, now) : stay_lost(now);
}

FrameState Tracker::extract(const RgbdFrame& frame, TraceSink* trace) {
  const Span span(trace, "extract");
  return extractor_.extract(frame);
}

bool Tracker::enough_to_start(const FrameState& now) const {
  return now.features_with_depth() >= options_.min_features_to_start;
}

const KnownMap* Tracker::place_last_frame(const KnownMaps& known) {
  const KeyframeId first = last_.name_own_keyframe(*known.active.map);
  if (first.valid()) keyframes_.name_first(first);
  return last_.find_in(known);
}

FrameStep Tracker::step_to(const FrameState& now, const Map& map) const {
  const double seconds = now.timestamp_s - last_.state().timestamp_s;
  const Se3& world_from_last = last_.world_from_camera();
  const Se3 predicted = motion_.predict(world_from_last, seconds);
  const MotionGate gate(options_, world_from_last, seconds,
                        motion_.known() ? std::optional(predicted) : std::nullopt);
  return {map, last_, now, seconds, predicted, gate};
}

std::optional<MatchedPose> Tracker::follow(const FrameStep& step, TraceSink* trace) {
  std::optional<FirstPose> first = last_frame_matcher_.match(step, trace);
  std::optional<MatchedPose> found;
  if (first) {
    const Span span(trace, "match_local_map");
    found = local_map_matcher_.refine(step.map, step.now, std::move(first->found),
                                      step.last.state().pose.keyframe, options_.local_search_radius_px);
  }
  if (found && !verifier_.follows(step, local_map_matcher_.local_map(), found->pose, first->guessed))
    found.reset();
  if (!found || found->pose.inliers < options_.few_inliers) {
    const Span span(trace, "align_surfaces");
    found = surfaces_.align(step, found);
  }
  return found;
}

std::optional<Relocalisation> Tracker::relocalise(const KnownMaps& known, const KnownMap* last_in,
                                                  const FrameState& now, TraceSink* trace) {
  const Span span(trace, "relocalise");
  return relocaliser_.search(known, last_in, last_, now);
}

// The request will become the first keyframe of a map, and this frame hangs on it.
TrackedFrame Tracker::start(FrameState& now) {
  loss_.measured(now.timestamp_s);
  motion_.forget();
  sightings_.clear();
  TrackedFrame result = report(now, TrackStatus::initialised, Se3{});
  result.matches = now.features_with_depth();
  result.keyframe_request = keyframes_.request(now, true, {});
  last_.set(std::move(now));
  return result;
}

// The pose was measured from the last frame on.
TrackedFrame Tracker::go_on(const FrameStep& step, const MatchedPose& found, FrameState& now, int backlog) {
  const FramePose& pose = found.pose;
  anchor(step.map, found, step.last.state().pose.keyframe, now);
  // What only the prediction held is passed on as weakly as it was known.
  now.tracked_link =
      link_to_anchor(now, pose.information + motion_prior(pose.world_from_camera, step.seconds).information,
                     options_.few_inliers);
  motion_.update(step.last.world_from_camera(), pose.world_from_camera, step.seconds, pose.measured);
  return answer(step.map, found, pose.degenerate ? TrackStatus::coasting : TrackStatus::ok, false, now,
                backlog);
}

// Found again after a loss. In a dormant map a keyframe is asked for in any case: it is what makes that map the active one.
TrackedFrame Tracker::resume(const Map& map, const MatchedPose& found, bool dormant, FrameState& now,
                             int backlog) {
  anchor(map, found, local_map_matcher_.local_map().reference(), now);
  now.tracked_link = link_to_anchor(now, found.pose.information, options_.few_inliers);
  motion_.forget();
  return answer(map, found, TrackStatus::relocalised, dormant, now, backlog);
}

// The last measured frame stays the one to match against; only the prediction moves on.
TrackedFrame Tracker::coast(const FrameStep& step, FrameState& now) const {
  const KeyframeId anchor = step.map.reanchor(step.last.state().pose)->keyframe;
  now.pose = {anchor, step.map.keyframes().find(anchor)->world_from_camera.inverse() * step.predicted};
  return report(now, TrackStatus::coasting, step.predicted);
}

TrackedFrame Tracker::stay_lost(FrameState& now) {
  loss_.lose();
  motion_.forget();
  if (enough_to_start(now) && loss_.searched_in_vain(now.timestamp_s)) return start(now);
  return report(now, TrackStatus::lost, Se3{});
}

// `near`: the keyframe to hang on where none held the pose.
void Tracker::anchor(const Map& map, const MatchedPose& found, KeyframeId near, FrameState& now) {
  sightings_.count(found.matches, local_map_matcher_.expected(), options_.min_inliers);
  anchor_frame(map, choose_anchor(local_map_matcher_.local_map(), found, near), found, now);
}

TrackedFrame Tracker::answer(const Map& map, const MatchedPose& found, TrackStatus status, bool always_keep,
                             FrameState& now, int backlog) {
  const Se3& world_from_camera = found.pose.world_from_camera;
  loss_.measured(now.timestamp_s);
  TrackedFrame result = report(now, status, world_from_camera);
  result.matches = found.pose.inliers;
  if (always_keep || keyframes_.wanted(map, now, world_from_camera, backlog))
    result.keyframe_request = keyframes_.request(now, false, sightings_.take());
  last_.set(std::move(now));
  return result;
}

}  // namespace vsgraphs
