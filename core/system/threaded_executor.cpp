#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <thread>

#include "core/base/bounded_queue.h"
#include "core/system/executor.h"
#include "core/system/map_owner.h"
#include "core/system/tracking_lane.h"

namespace vsgraphs {

namespace {

// The caller's thread tracks; one worker owns the map.
class ThreadedExecutor : public Executor {
 public:
  ThreadedExecutor(const Config& config, const Camera& camera, const AtlasState& known)
      : options_(config.system),
        tracking_(config, camera),
        owner_(config, camera, cell_, known),
        requests_(queue_capacity) {
    worker_ = std::thread([this] { work(); });
  }
  ~ThreadedExecutor() override { stop_worker(); }

  std::optional<TrackedFrame> track(const RgbdFrame& frame) override {
    rethrow_worker_failure();
    TrackedFrame result = tracking_.track(frame, cell_.take());
    if (result.keyframe_request) requests_.push({result.keyframe_request, 0, nullptr, nullptr});
    // Nothing can be tracked before a map's first keyframe stands.
    if (result.status == TrackStatus::initialised) cell_.wait_for_inserted(tracking_.requested());
    if (!options_.realtime) wait_for_mapper();
    return result;
  }

  void label(std::int64_t frame_index, std::shared_ptr<const LabelGrid> labels) override {
    if (options_.builds_scene()) requests_.push({nullptr, frame_index, std::move(labels), nullptr});
  }

  void mark(std::int64_t frame_index, std::shared_ptr<const MarkerDetections> detections) override {
    requests_.push({nullptr, frame_index, nullptr, std::move(detections)});
  }

  void finish() override {
    stop_worker();
    rethrow_worker_failure();
  }

  SnapshotCell::Content content() const override { return cell_.take(); }
  std::shared_ptr<const FreeSpace> free_space() const override { return owner_.free_space(); }
  std::int64_t backlog() const override { return tracking_.requested() - cell_.take().inserted; }
  double waited_s() const override { return waited_s_; }
  std::vector<const SpanRecorder*> spans() const override { return lanes(tracking_, owner_); }
  Schedule schedule() const override { return {tracking_.frames(), owner_.edits()}; }

 private:
  // Far above what the keyframe policy lets wait, so that a push never blocks at camera pace.
  static constexpr std::size_t queue_capacity = 64;
  // Keyframes that wait while the whole map is adjusted, at the most: then it is cut short.
  static constexpr std::size_t adjustment_backlog = 8;

  // A keyframe to make, or what was found in the image of one.
  struct Work {
    std::shared_ptr<const KeyframeRequest> request;
    std::int64_t frame = 0;
    std::shared_ptr<const LabelGrid> labels;
    std::shared_ptr<const MarkerDetections> markers;
  };

  void work() {
    // Tracking is what a user waits for; on Linux the priority is the thread's own.
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 5);
    try {
      while (const auto work = requests_.pop()) {
        if (work->labels) owner_.label(work->frame, *work->labels);
        if (work->markers) owner_.mark(work->frame, *work->markers);
        if (!work->request) continue;
        owner_.work_on(
            *work->request, [this] { return cut_short(); },
            [this] { return requests_.size() >= adjustment_backlog; });
      }
      owner_.end_run();
    } catch (const std::exception& error) {
      // Whatever it was, it was not the frame the tracker is at: it must not look like bad input of that frame.
      failure_ = std::make_exception_ptr(std::runtime_error(std::string("mapping failed: ") + error.what()));
      requests_.close();
    }
    cell_.close();
  }

  // At the camera's pace, a window's adjustment gives way to the keyframes that wait. Otherwise tracking waits for it, so
  // that accuracy does not hang on how fast the machine is.
  bool cut_short() const { return options_.realtime && requests_.size() >= 2; }

  void wait_for_mapper() {
    const std::int64_t needed = tracking_.requested() - options_.max_waiting_keyframes;
    if (cell_.take().inserted >= needed) return;
    const auto begin = std::chrono::steady_clock::now();
    cell_.wait_for_inserted(needed);
    waited_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  void stop_worker() {
    requests_.close();
    if (worker_.joinable()) worker_.join();
  }

  // The worker closes the queue before it leaves, and a closed queue is seen through its lock: so is `failure_`.
  void rethrow_worker_failure() {
    if (!requests_.closed()) return;
    stop_worker();
    if (failure_) std::rethrow_exception(failure_);
  }

  SystemOptions options_;
  SnapshotCell cell_;
  TrackingLane tracking_;
  MapOwner owner_;
  BoundedQueue<Work> requests_;
  std::exception_ptr failure_;
  double waited_s_ = 0;
  std::thread worker_;
};

}  // namespace

std::unique_ptr<Executor> make_threaded_executor(const Config& config, const Camera& camera,
                                                 const AtlasState& known) {
  return std::make_unique<ThreadedExecutor>(config, camera, known);
}

}  // namespace vsgraphs
