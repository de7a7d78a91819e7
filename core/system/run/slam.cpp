#include "core/system/run/slam.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>

#include "core/base/check.h"

namespace vsgraphs {

namespace {

bool has_keyframes(const AtlasState& known) {
  return std::any_of(known.maps.begin(), known.maps.end(),
                     [](const MapState& m) { return m.map->keyframes().size() > 0; });
}

std::unique_ptr<Executor> make_executor(const Config& config, const Camera& camera, const AtlasState& known,
                                        std::shared_ptr<MapListener> listener) {
  camera.validate();
  config.validate();
  require_input(!config.system.localise_only || has_keyframes(known),
                "system.localise_only needs a map to locate the camera in; load an atlas that holds one");
  if (!config.system.replay.empty())
    return make_replaying_executor(config, camera, known, std::move(listener));
  if (config.system.execution == "serial")
    return make_serial_executor(config, camera, known, std::move(listener));
  return make_threaded_executor(config, camera, known, std::move(listener));
}

// Frames of this run come after those of all others that went into the maps.
std::int64_t first_index_after(const AtlasState& known) {
  std::int64_t next = 0;
  for (const MapState& state : known.maps)
    state.map->keyframes().for_each(
        [&next](KeyframeId, const Keyframe& k) { next = std::max(next, k.frame_index + 1); });
  return next;
}

// Some thousand years; nanoseconds since 1970 are beyond it.
constexpr double latest_s = 1e11;

std::string at_time(double timestamp_s) {
  char text[64];
  std::snprintf(text, sizeof text, std::abs(timestamp_s) > latest_s ? "%g s" : "%.6f s", timestamp_s);
  return text;
}

std::vector<TimedPose> poses_in(const Map& map, const FrameRecords::View& records) {
  // A frame that became a keyframe is where its keyframe is.
  std::map<std::int64_t, Se3> keyframe_pose;
  map.keyframes().for_each(
      [&](KeyframeId, const Keyframe& k) { keyframe_pose[k.frame_index] = k.world_from_camera; });
  std::vector<TimedPose> result;
  result.reserve(records.size());
  records.for_each([&](const FrameRecord& record) {
    const auto own = keyframe_pose.find(record.index);
    const auto pose = own != keyframe_pose.end() ? std::optional<Se3>(own->second) : map.resolve(record.pose);
    if (pose) result.push_back({record.timestamp_s, *pose});
  });
  return result;
}

}  // namespace

Slam::Slam(const Config& config, const Camera& camera) : Slam(config, camera, AtlasState{}) {}

Slam::Slam(const Config& config, const Camera& camera, const AtlasState& known,
           std::shared_ptr<MapListener> listener)
    : process_(::getpid()),
      config_(config),
      camera_(camera),
      executor_(make_executor(config, camera, known, std::move(listener))),
      loaded_(known.loaded),
      first_index_(first_index_after(known)),
      last_timestamp_s_(-std::numeric_limits<double>::infinity()),
      lost_(has_keyframes(known)),
      starts_lost_(lost_) {
  for (const MapState& state : known.maps) classes_.take(state.map->class_names());
}

Slam::~Slam() {
  if (::getpid() != process_) static_cast<void>(executor_.release());
}

void Slam::require_own_process() const {
  if (::getpid() != process_)
    throw RunError("this Slam belongs to the process that made it; make a new one after fork()");
}

TrackedFrame Slam::track(RgbdFrame frame) {
  require_own_process();
  const std::unique_lock lock(frames_mutex_, std::try_to_lock);
  require_input(lock.owns_lock(),
                "track() was called while another thread was in it; frames come one by one");
  require_input(!finished_, "track() was called after finish(); make a new Slam for a new run");
  require_input(std::isfinite(frame.timestamp_s), "the frame's timestamp is not a finite number");
  require_input(
      std::abs(frame.timestamp_s) <= latest_s,
      "the frame's timestamp " + at_time(frame.timestamp_s) + " is beyond any time in seconds; give seconds");
  require_input(frame.timestamp_s > last_timestamp_s_, "the frame's timestamp " + at_time(frame.timestamp_s) +
                                                           " is not later than the last one's, " +
                                                           at_time(last_timestamp_s_));
  frame.index = first_index_ + frames_;
  const auto tracked = executor_->track(frame);
  if (!tracked) {
    TrackedFrame skipped;
    skipped.timestamp_s = frame.timestamp_s;
    return skipped;
  }
  last_timestamp_s_ = frame.timestamp_s;
  ++frames_;
  keep_record(*tracked);
  note_status(*tracked);
  return *tracked;
}

// A frame that starts a map names no keyframe; its own is there when the next frame has been tracked.
void Slam::keep_record(const TrackedFrame& frame) {
  if (const FrameRecord* unnamed = records_.unnamed())
    records_.name_newest(snapshot()->keyframe_of_frame(unnamed->index));
  if (has_pose(frame.status)) records_.append({frame.index, frame.timestamp_s, frame.pose});
}

void Slam::warn(std::string line) {
  const std::lock_guard lock(warnings_mutex_);
  warnings_.push_back(std::move(line));
}

void Slam::note_status(const TrackedFrame& frame) {
  if (frame.status == TrackStatus::lost && !lost_) {
    warn("tracking was lost at " + at_time(frame.timestamp_s));
    lost_ = true;
  } else if (frame.status == TrackStatus::relocalised) {
    warn(starts_lost_ ? "found in the loaded map at " + at_time(frame.timestamp_s)
                      : "tracking was recovered (relocalised) at " + at_time(frame.timestamp_s));
    lost_ = starts_lost_ = false;
  } else if (frame.status == TrackStatus::initialised && lost_) {
    warn("nothing known was recognised; a new map was started at " + at_time(frame.timestamp_s));
    lost_ = starts_lost_ = false;
  }
}

void Slam::add_segmentation(std::int64_t frame_index, const Segmentation& segmentation) {
  require_own_process();
  auto labels = std::make_shared<const LabelGrid>(sample_labels(segmentation, camera_));
  classes_.take(labels->class_names);
  if (!finished_) executor_->label(frame_index, std::move(labels));
}

void Slam::add_markers(std::int64_t frame_index, MarkerDetections detections) {
  require_own_process();
  check_markers(detections);
  if (!finished_)
    executor_->mark(frame_index, std::make_shared<const MarkerDetections>(std::move(detections)));
}

Snapshot Slam::snapshot() const {
  require_own_process();
  return executor_->content().snapshot;
}

AtlasState Slam::atlas_state() const {
  require_own_process();
  return {executor_->maps(), loaded_};
}

std::int64_t Slam::backlog() const {
  require_own_process();
  return executor_->backlog();
}

std::vector<const SpanRecorder*> Slam::spans() const {
  require_own_process();
  return ended_ ? executor_->spans() : std::vector<const SpanRecorder*>{};
}

void Slam::stop() {
  require_own_process();
  executor_->stop();
}

void Slam::finish() {
  require_own_process();
  const std::lock_guard lock(frames_mutex_);
  if (finished_) return;
  finished_ = true;
  std::exception_ptr failure;
  try {
    executor_->finish();
  } catch (...) {
    failure = std::current_exception();
  }
  ended_ = true;
  // The schedule of a run that failed is what one wants to look at.
  if (!config_.system.schedule_out.empty()) executor_->schedule().write(config_.system.schedule_out);
  if (failure) std::rethrow_exception(failure);
}

std::vector<TimedPose> Slam::trajectory() const {
  require_own_process();
  const FrameRecords::View records = records_.view();
  return poses_in(*map_given_out(records), records);
}

Snapshot Slam::map_given_out(const FrameRecords::View& records) const {
  const SnapshotCell::Content content = executor_->content();
  Snapshot best = content.snapshot;
  if (!config_.system.localise_only) return best;
  std::size_t most = poses_in(*best, records).size();
  for (const MapState& other : *content.dormant) {
    const std::size_t count = poses_in(*other.map, records).size();
    if (count <= most) continue;
    most = count;
    best = other.map;
  }
  return best;
}

RunStatistics Slam::statistics() const {
  require_own_process();
  const SnapshotCell::Content content = executor_->content();
  RunStatistics s;
  s.frames = frames_;
  s.tracked = records_.size();
  s.waited_s = executor_->waited_s();
  s.maps = static_cast<int>(content.dormant->size()) + (content.snapshot->keyframes().size() > 0 ? 1 : 0);
  s.loops = content.counts.loops;
  s.merges = content.counts.merges;
  if (content.tallies) s.tallies = *content.tallies;
  {
    const std::lock_guard lock(warnings_mutex_);
    s.warnings = warnings_;
  }
  s.warnings.insert(s.warnings.end(), content.faults->begin(), content.faults->end());
  if (ended_) add_what_the_end_tells(s);
  return s;
}

void Slam::add_what_the_end_tells(RunStatistics& s) const {
  const FrameRecords::View records = records_.view();
  s.elsewhere = s.tracked - static_cast<std::int64_t>(poses_in(*map_given_out(records), records).size());
  s.stages = stage_statistics(executor_->spans());
  const AtlasCounts counts = executor_->content().counts;
  if (counts.dropped_maps > 0)
    s.warnings.push_back(std::to_string(counts.dropped_maps) + " map(s) of fewer than " +
                         std::to_string(config_.system.min_map_keyframes) +
                         " keyframes were dropped when a new one began");
  if (executor_->backlog() > 0)
    s.warnings.push_back(std::to_string(executor_->backlog()) +
                         " keyframes waited for mapping when the run was stopped; the map lacks them");
  if (counts.unadjusted)
    s.warnings.push_back("the run was stopped before the whole map was adjusted to its last loop");
  if (s.elsewhere > 0)
    s.warnings.push_back(std::to_string(s.elsewhere) +
                         " tracked frames are in maps that were never joined with the one given out; the "
                         "trajectory leaves them out");
}

}  // namespace vsgraphs
