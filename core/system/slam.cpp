#include "core/system/slam.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>

#include "core/base/check.h"

namespace vsgraphs {

namespace {

std::unique_ptr<Executor> make_executor(const Config& config, const Camera& camera) {
  camera.validate();
  config.validate();
  if (!config.system.replay.empty()) return make_replaying_executor(config, camera);
  if (config.system.execution == "serial") return make_serial_executor(config, camera);
  return make_threaded_executor(config, camera);
}

std::string at_time(double timestamp_s) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6f s", timestamp_s);
  return text;
}

}  // namespace

Slam::Slam(const Config& config, const Camera& camera)
    : config_(config),
      camera_(camera),
      executor_(make_executor(config, camera)),
      last_timestamp_s_(-std::numeric_limits<double>::infinity()) {}

Slam::~Slam() = default;

TrackedFrame Slam::track(RgbdFrame frame) {
  const std::unique_lock lock(frames_mutex_, std::try_to_lock);
  require_input(lock.owns_lock(),
                "track() was called while another thread was in it; frames come one by one");
  require_input(!finished_, "track() was called after finish(); make a new Slam for a new run");
  require_input(std::isfinite(frame.timestamp_s), "the frame's timestamp is not a finite number");
  require_input(frame.timestamp_s > last_timestamp_s_, "the frame's timestamp " + at_time(frame.timestamp_s) +
                                                           " is not later than the last one's, " +
                                                           at_time(last_timestamp_s_));
  frame.index = frames_;
  const auto tracked = executor_->track(frame);
  if (!tracked) {
    TrackedFrame skipped;
    skipped.timestamp_s = frame.timestamp_s;
    return skipped;
  }
  last_timestamp_s_ = frame.timestamp_s;
  ++frames_;
  if (has_pose(tracked->status)) records_.push_back({tracked->index, tracked->timestamp_s, tracked->pose});
  note_status(*tracked);
  return *tracked;
}

void Slam::note_status(const TrackedFrame& frame) {
  if (frame.status == TrackStatus::lost && !lost_) {
    warnings_.push_back("tracking was lost at " + at_time(frame.timestamp_s));
    lost_ = true;
  } else if (frame.status == TrackStatus::relocalised) {
    warnings_.push_back("tracking was recovered (relocalised) at " + at_time(frame.timestamp_s));
    lost_ = false;
  }
}

void Slam::add_segmentation(std::int64_t frame_index, const Segmentation& segmentation) {
  auto labels = std::make_shared<const LabelGrid>(sample_labels(segmentation, camera_));
  if (!finished_) executor_->label(frame_index, std::move(labels));
}

void Slam::add_markers(std::int64_t frame_index, MarkerDetections detections) {
  check_markers(detections);
  if (!finished_)
    executor_->mark(frame_index, std::make_shared<const MarkerDetections>(std::move(detections)));
}

Snapshot Slam::snapshot() const { return executor_->snapshot(); }

std::int64_t Slam::backlog() const {
  const std::lock_guard lock(frames_mutex_);
  return executor_->backlog();
}

std::vector<const SpanRecorder*> Slam::spans() const {
  const std::lock_guard lock(frames_mutex_);
  return finished_ ? executor_->spans() : std::vector<const SpanRecorder*>{};
}

void Slam::finish() {
  const std::lock_guard lock(frames_mutex_);
  if (finished_) return;
  finished_ = true;
  std::exception_ptr failure;
  try {
    executor_->finish();
  } catch (...) {
    failure = std::current_exception();
  }
  // The schedule of a run that failed is what one wants to look at.
  if (!config_.system.schedule_out.empty()) executor_->schedule().write(config_.system.schedule_out);
  if (failure) std::rethrow_exception(failure);
}

std::vector<TimedPose> Slam::trajectory() const {
  const std::lock_guard lock(frames_mutex_);
  const Snapshot map = snapshot();
  // A frame that became a keyframe is where its keyframe is.
  std::map<std::int64_t, Se3> keyframe_pose;
  map->keyframes().for_each(
      [&](KeyframeId, const Keyframe& k) { keyframe_pose[k.frame_index] = k.world_from_camera; });
  std::vector<TimedPose> result;
  result.reserve(records_.size());
  for (const FrameRecord& record : records_) {
    const auto own = keyframe_pose.find(record.index);
    const auto pose =
        own != keyframe_pose.end() ? std::optional<Se3>(own->second) : map->resolve(record.pose);
    if (pose) result.push_back({record.timestamp_s, *pose});
  }
  return result;
}

RunStatistics Slam::statistics() const {
  const std::lock_guard lock(frames_mutex_);
  RunStatistics s;
  s.frames = frames_;
  s.tracked = static_cast<std::int64_t>(records_.size());
  s.waited_s = executor_->waited_s();
  if (finished_) s.stages = stage_statistics(executor_->spans());
  s.warnings = warnings_;
  return s;
}

}  // namespace vsgraphs
