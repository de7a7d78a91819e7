#include "core/system/executor.h"
#include "core/system/map_owner.h"
#include "core/system/tracking_lane.h"

namespace vsgraphs {

namespace {

class SerialExecutor : public Executor {
 public:
  SerialExecutor(const Config& config, const Camera& camera, const AtlasState& known)
      : options_(config.system), tracking_(config, camera), owner_(config, camera, cell_, known) {}

  std::optional<TrackedFrame> track(const RgbdFrame& frame) override {
    TrackedFrame result = tracking_.track(frame, cell_.take());
    if (result.keyframe_request) owner_.work_on(*result.keyframe_request, {});
    owner_.adjust_here();
    return result;
  }
  void label(std::int64_t frame_index, std::shared_ptr<const LabelGrid> labels) override {
    if (options_.builds_scene()) owner_.label(frame_index, *labels);
  }
  void mark(std::int64_t frame_index, std::shared_ptr<const MarkerDetections> detections) override {
    owner_.mark(frame_index, *detections);
  }
  void finish() override {
    if (!finished_) owner_.end_run();
    finished_ = true;
  }
  SnapshotCell::Content content() const override { return cell_.take(); }
  std::shared_ptr<const FreeSpace> free_space() const override { return owner_.free_space(); }
  std::int64_t backlog() const override { return 0; }
  std::vector<const SpanRecorder*> spans() const override { return lanes(tracking_, owner_); }
  Schedule schedule() const override { return {tracking_.frames(), owner_.edits()}; }

 private:
  SystemOptions options_;
  bool finished_ = false;
  SnapshotCell cell_;
  TrackingLane tracking_;
  MapOwner owner_;
};

}  // namespace

std::unique_ptr<Executor> make_serial_executor(const Config& config, const Camera& camera,
                                               const AtlasState& known) {
  return std::make_unique<SerialExecutor>(config, camera, known);
}

}  // namespace vsgraphs
