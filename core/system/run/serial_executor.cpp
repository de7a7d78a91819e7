#include <atomic>
#include <mutex>

#include "core/system/maps/map_owner.h"
#include "core/system/run/executor.h"
#include "core/system/run/tracking_lane.h"

namespace vsgraphs {

namespace {

class SerialExecutor : public Executor {
 public:
  SerialExecutor(const Config& config, const Camera& camera, const AtlasState& known,
                 std::shared_ptr<MapListener> listener)
      : options_(config.system),
        tracking_(config, camera),
        owner_(config, camera, cell_, known, std::move(listener)) {}

  std::optional<TrackedFrame> track(const RgbdFrame& frame) override {
    if (stopped_) return std::nullopt;
    const std::lock_guard lock(owner_mutex_);
    TrackedFrame result = tracking_.track(frame, cell_.take());
    const auto stopped = [this] { return stopped_.load(); };
    if (result.keyframe_request) owner_.work_on(*result.keyframe_request, stopped, stopped);
    owner_.adjust_here(stopped);
    return result;
  }
  void label(std::int64_t frame_index, std::shared_ptr<const LabelGrid> labels) override {
    const std::lock_guard lock(owner_mutex_);
    if (options_.builds_scene() && owner_.label(frame_index, *labels)) owner_.interpret_planes();
  }
  void mark(std::int64_t frame_index, std::shared_ptr<const MarkerDetections> detections) override {
    const std::lock_guard lock(owner_mutex_);
    owner_.mark(frame_index, *detections);
  }
  void finish() override {
    const std::lock_guard lock(owner_mutex_);
    if (!finished_) owner_.end_run([this] { return stopped_.load(); });
    finished_ = true;
  }
  void stop() override { stopped_ = true; }
  SnapshotCell::Content content() const override { return cell_.take(); }
  std::vector<MapState> maps() const override {
    const std::lock_guard lock(owner_mutex_);
    return owner_.maps();
  }
  std::int64_t backlog() const override { return 0; }
  std::vector<const SpanRecorder*> spans() const override { return lanes(tracking_, owner_); }
  Schedule schedule() const override { return {tracking_.frames(), owner_.edits()}; }

 private:
  SystemOptions options_;
  bool finished_ = false;
  std::atomic<bool> stopped_ = false;
  SnapshotCell cell_;
  TrackingLane tracking_;
  mutable std::mutex owner_mutex_;  // only maps() comes from another thread
  MapOwner owner_;
};

}  // namespace

std::unique_ptr<Executor> make_serial_executor(const Config& config, const Camera& camera,
                                               const AtlasState& known,
                                               std::shared_ptr<MapListener> listener) {
  return std::make_unique<SerialExecutor>(config, camera, known, std::move(listener));
}

}  // namespace vsgraphs
