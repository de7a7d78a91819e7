#include "core/system/executor.h"
#include "core/system/map_owner.h"
#include "core/system/tracking_lane.h"

namespace vsgraphs {

namespace {

class SerialExecutor : public Executor {
 public:
  SerialExecutor(const Config& config, const Camera& camera)
      : options_(config.system), tracking_(config, camera), owner_(config, camera, cell_) {}

  std::optional<TrackedFrame> track(const RgbdFrame& frame) override {
    TrackedFrame result = tracking_.track(frame, cell_.take());
    if (result.keyframe_request) {
      owner_.insert(*result.keyframe_request);
      if (options_.builds_scene()) owner_.find_planes();
      if (options_.builds_structure() && owner_.rooms_due()) owner_.find_rooms(false);
      owner_.refine([] { return false; });
      owner_.look_for_loop();
      if (owner_.loop_found()) {
        owner_.close_loop();
        owner_.adjust_all([] { return false; });
        if (options_.builds_structure()) owner_.find_rooms(false);
      }
    }
    return result;
  }
  void label(std::int64_t frame_index, std::shared_ptr<const LabelGrid> labels) override {
    if (options_.builds_scene()) owner_.label(frame_index, *labels);
  }
  void mark(std::int64_t frame_index, std::shared_ptr<const MarkerDetections> detections) override {
    owner_.mark(frame_index, *detections);
  }
  void finish() override {
    if (options_.builds_structure() && tracking_.requested() > 0 && !finished_) owner_.find_rooms(true);
    finished_ = true;
  }
  Snapshot snapshot() const override { return cell_.take().snapshot; }
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

std::unique_ptr<Executor> make_serial_executor(const Config& config, const Camera& camera) {
  return std::make_unique<SerialExecutor>(config, camera);
}

}  // namespace vsgraphs
