#include "core/tracking/tracker.h"

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

TrackedFrame Tracker::track(const RgbdFrame& frame, const KnownMaps& known, int backlog, TraceSink* trace) {
  extract(frame, trace);
  visible_now_.clear();
  if (known.empty() && !last_) return enough_to_start() ? start() : report(TrackStatus::waiting, Se3{});
  const KnownMap* last_in = place_last_frame(known);
  if (!last_in) lost_ = true;
  if (lost_) {
    const auto found = relocalise(known, last_in, trace);
    return found ? finish_relocalised(known, *found, backlog) : stay_lost();
  }
  const Map& map = *last_in->map;
  const double seconds = now_.timestamp_s - last_->timestamp_s;
  predicted_ = motion_.predict(*last_world_, seconds);
  const std::optional<FramePose> pose = follow(map, seconds, trace);
  if (pose) return finish(map, *pose, last_->pose.keyframe, backlog);
  ++unmeasured_frames_;
  return loses_track() ? stay_lost() : coast(map);
}

// The map that holds the last frame, which may have been moved or joined with another since; null if none does.
const KnownMap* Tracker::place_last_frame(const KnownMaps& known) {
  last_world_.reset();
  if (!last_) return nullptr;
  // The keyframe made of a frame that started a map had no name then.
  if (!last_->pose.keyframe.valid()) {
    last_->pose.keyframe = known.active.map->keyframe_of_frame(last_->index);
    if (!last_keyframe_pose_->keyframe.valid()) last_keyframe_pose_->keyframe = last_->pose.keyframe;
  }
  const auto holds = [this](const KnownMap& candidate) {
    const auto living = candidate.map->reanchor(last_->pose);
    if (!living) return false;
    last_->pose = *living;
    last_world_ = *candidate.map->resolve(*living);
    adopt_landmarks_of_own_keyframe(*candidate.map);
    return true;
  };
  if (holds(known.active)) return &known.active;
  for (const KnownMap& dormant : known.dormant) {
    if (holds(dormant)) return &dormant;
  }
  return nullptr;
}

std::optional<FramePose> Tracker::follow(const Map& map, double seconds, TraceSink* trace) {
  bool guessed = false;  // found without prediction: to be checked against the surfaces
  std::optional<FramePose> pose = match_recent(map, guessed, trace);
  if (pose) {
    const Span span(trace, "match_local_map");
    pose = refine_on_local_map(map, *pose, last_->pose.keyframe, options_.local_search_radius_px);
  }
  if (pose && guessed && !surfaces_agree(map, *pose)) pose.reset();
  if (pose && leaps(*pose) && !leaves_surfaces_standing(map, *pose)) pose.reset();
  if (pose && !believable(pose->world_from_camera, seconds)) pose.reset();
  if (!pose || pose->inliers < options_.few_inliers) {
    const Span span(trace, "align_surfaces");
    pose = align_surfaces(map, pose, seconds);
  }
  return pose;
}

// Whatever might be the place is tried to the end: the last frame's surroundings first, then what looks most alike, in the
// map the camera was lost in, the active one and the others.
std::optional<Tracker::Found> Tracker::relocalise(const KnownMaps& known, const KnownMap* last_in,
                                                  TraceSink* trace) {
  const Span span(trace, "relocalise");
  if (last_in) {
    const auto& last = *last_;
    const auto pose = search_around(
        *last_in->map,
        recovery_.from_recent(*last_in->map, *now_.features, now_.index,
                              {*last.features, last.landmarks, *last_world_}, last.pose.keyframe),
        last.pose.keyframe, options_.recovery.min_relocalisation_inliers);
    if (pose && believable(pose->world_from_camera, now_.timestamp_s - last.timestamp_s))
      return Found{last_in, *pose};
  }
  std::vector<const KnownMap*> order;
  if (last_in) order.push_back(last_in);
  if (last_in != &known.active) order.push_back(&known.active);
  for (const KnownMap& dormant : known.dormant) {
    if (last_in != &dormant) order.push_back(&dormant);
  }
  for (const KnownMap* candidate : order) {
    const Map& map = *candidate->map;
    const bool was_here = candidate == last_in;
    // Nothing says that the camera is in this map at all. Where it may start one of its own there is time: what the two have in
    // common will show, from more than one view.
    const bool may_wait = !was_here && std::isfinite(options_.new_map_after_s);
    const int enough = (may_wait ? 2 : 1) * options_.recovery.min_place_inliers;
    const RoomNumber last_room = was_here ? map.room_at(last_world_->translation()) : no_room;
    for (const KeyframeId place : recovery_.likely_places(*candidate, *now_.features, last_room)) {
      const auto pose =
          search_around(map, recovery_.from_keyframe(map, place, *now_.features, now_.index), place, enough);
      if (!pose) continue;
      if (was_here && !believable(pose->world_from_camera, now_.timestamp_s - last_->timestamp_s)) continue;
      return Found{candidate, *pose};
    }
  }
  return std::nullopt;
}

// A pose by look from one keyframe may rest on few matches: what lies around is looked for, first widely, then narrowly,
// and must be there.
std::optional<FramePose> Tracker::search_around(const Map& map, std::optional<MatchedPose> found,
                                                KeyframeId near, int min_inliers) {
  if (!found) return std::nullopt;
  std::optional<FramePose> guess = found->pose;
  matches_ = std::move(found->matches);
  for (const double radius_px : {options_.search_radius_px, options_.local_search_radius_px}) {
    if (!guess) return std::nullopt;
    guess = refine_on_local_map(map, *guess, near, radius_px);
  }
  const bool good = guess && guess->inliers >= min_inliers && surfaces_agree(map, *guess) &&
                    leaves_surfaces_standing(map, *guess);
  return good ? guess : std::nullopt;
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

bool Tracker::enough_to_start() const {
  const auto with_depth = std::count_if(now_.features->features().begin(), now_.features->features().end(),
                                        [](const Feature& f) { return f.has_depth(); });
  return with_depth >= options_.min_features_to_start;
}

// The request will become the first keyframe of a map, and this frame hangs on it.
TrackedFrame Tracker::start() {
  now_.pose = {};
  lost_ = false;
  searching_since_s_.reset();
  motion_.forget();
  sightings_.clear();
  last_measured_s_ = now_.timestamp_s;
  unmeasured_frames_ = 0;
  TrackedFrame result = report(TrackStatus::initialised, Se3{});
  result.matches =
      static_cast<int>(std::count_if(now_.features->features().begin(), now_.features->features().end(),
                                     [](const Feature& f) { return f.has_depth(); }));
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
