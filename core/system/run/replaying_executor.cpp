#include <atomic>
#include <deque>
#include <map>
#include <mutex>

#include "core/base/check.h"
#include "core/system/maps/map_owner.h"
#include "core/system/run/executor.h"
#include "core/system/run/tracking_lane.h"

namespace vsgraphs {

namespace {

// Serial, but each frame sees the map version it saw in the recorded run.
class ReplayingExecutor : public Executor {
 public:
  ReplayingExecutor(const Config& config, const Camera& camera, const AtlasState& known,
                    std::shared_ptr<MapListener> listener)
      : schedule_(Schedule::read(config.system.replay)),
        tracking_(config, camera),
        owner_(config, camera, cell_, known, std::move(listener)) {}

  std::optional<TrackedFrame> track(const RgbdFrame& frame) override {
    if (stopped_ || next_frame_ >= schedule_.frames.size()) return std::nullopt;
    const FrameEvent& event = schedule_.frames[next_frame_];
    if (event.timestamp_s != frame.timestamp_s) return std::nullopt;  // dropped in the recorded run
    ++next_frame_;
    const std::lock_guard lock(owner_mutex_);
    advance_to(event.version);
    TrackedFrame result = tracking_.track(frame, cell_.take());
    if (result.keyframe_request) waiting_.push_back(result.keyframe_request);
    return result;
  }

  void label(std::int64_t frame_index, std::shared_ptr<const LabelGrid> labels) override {
    labels_[frame_index] = std::move(labels);
  }

  void mark(std::int64_t frame_index, std::shared_ptr<const MarkerDetections> detections) override {
    markers_[frame_index] = std::move(detections);
  }

  void finish() override {
    if (stopped_) return;
    require_run(next_frame_ == schedule_.frames.size(),
                "replay: the schedule holds " + std::to_string(schedule_.frames.size()) +
                    " frames, but only " + std::to_string(next_frame_) +
                    " of them came; replay it on the sequence it was recorded on");
    const std::lock_guard lock(owner_mutex_);
    advance_to(schedule_.edits.size());
  }
  void stop() override { stopped_ = true; }

  SnapshotCell::Content content() const override { return cell_.take(); }
  std::vector<MapState> maps() const override {
    const std::lock_guard lock(owner_mutex_);
    return owner_.maps();
  }
  std::int64_t backlog() const override { return static_cast<std::int64_t>(waiting_.size()); }
  std::vector<const SpanRecorder*> spans() const override { return lanes(tracking_, owner_); }
  Schedule schedule() const override { return {tracking_.frames(), owner_.edits()}; }

 private:
  void advance_to(std::uint64_t version) {
    while (owner_.version() < version && !stopped_) {
      require_run(owner_.version() < schedule_.edits.size(),
                  "replay: the schedule ends before its last frame; it was cut off");
      const EditEvent& event = schedule_.edits[owner_.version()];
      repeat(event);
      require_run(owner_.edits().back() == event, departed(event));
    }
  }

  void repeat(const EditEvent& event) {
    switch (event.kind) {
      case EditEvent::Kind::insert:
        require_run(!waiting_.empty() && waiting_.front()->frame_index == event.frame, departed(event));
        owner_.insert(*waiting_.front());
        waiting_.pop_front();
        break;
      case EditEvent::Kind::planes:
        owner_.find_planes();
        break;
      case EditEvent::Kind::labels: {
        const auto labels = labels_.find(event.frame);
        require_run(labels != labels_.end(),
                    "replay: frame " + std::to_string(event.frame) +
                        " was segmented in the recorded run and is not now; give the same --segmenter");
        require_run(owner_.label(event.frame, *labels->second), departed(event));
        break;
      }
      case EditEvent::Kind::markers: {
        const auto markers = markers_.find(event.frame);
        require_run(markers != markers_.end(),
                    "replay: markers were seen in frame " + std::to_string(event.frame) +
                        " of the recorded run and are not now; give the same --markers");
        require_run(owner_.mark(event.frame, *markers->second), departed(event));
        break;
      }
      case EditEvent::Kind::roles:
        owner_.interpret_planes();
        break;
      case EditEvent::Kind::rooms:
      case EditEvent::Kind::rooms_last:
        owner_.find_rooms(event.kind == EditEvent::Kind::rooms_last);
        break;
      case EditEvent::Kind::refine: {
        int left = event.iterations;
        owner_.refine([&left] { return left-- <= 0; });
        owner_.look_for_loop();
        if (!owner_.loop_found()) owner_.look_for_join();
        break;
      }
      case EditEvent::Kind::new_map:
      case EditEvent::Kind::resume:
        require_run(!waiting_.empty() && owner_.choose_map(*waiting_.front()), departed(event));
        break;
      case EditEvent::Kind::join:
        require_run(owner_.join_found(), departed(event));
        owner_.join_maps();
        break;
      case EditEvent::Kind::settle:
        require_run(owner_.settle(), departed(event));
        break;
      case EditEvent::Kind::loop:
        require_run(owner_.loop_found(), departed(event));
        owner_.close_loop();
        break;
      case EditEvent::Kind::adjust:
        require_run(owner_.adjustment() != nullptr, departed(event));
        owner_.run_adjustment();
        owner_.take_in_adjustment();
        break;
    }
  }

  static void require_run(bool ok, const std::string& message) {
    if (!ok) throw RunError(message);
  }
  static std::string departed(const EditEvent& event) {
    return "replay: the run departs from the schedule at frame " + std::to_string(event.frame) +
           "; it was recorded with another sequence, configuration or build";
  }

  Schedule schedule_;
  std::atomic<bool> stopped_ = false;
  SnapshotCell cell_;
  TrackingLane tracking_;
  mutable std::mutex owner_mutex_;  // only maps() comes from another thread
  MapOwner owner_;
  std::size_t next_frame_ = 0;
  std::deque<std::shared_ptr<const KeyframeRequest>> waiting_;
  std::map<std::int64_t, std::shared_ptr<const LabelGrid>> labels_;
  std::map<std::int64_t, std::shared_ptr<const MarkerDetections>> markers_;
};

}  // namespace

std::unique_ptr<Executor> make_replaying_executor(const Config& config, const Camera& camera,
                                                  const AtlasState& known,
                                                  std::shared_ptr<MapListener> listener) {
  return std::make_unique<ReplayingExecutor>(config, camera, known, std::move(listener));
}

}  // namespace vsgraphs
