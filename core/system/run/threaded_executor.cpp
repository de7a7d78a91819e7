#include <atomic>
#include <chrono>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <thread>

#include "core/base/bounded_queue.h"
#include "core/system/maps/map_owner.h"
#include "core/system/run/background_adjustment.h"
#include "core/system/run/executor.h"
#include "core/system/run/thread_priority.h"
#include "core/system/run/tracking_lane.h"

namespace vsgraphs {

namespace {

// The caller's thread tracks; one worker owns the map; a third thread adjusts the whole map when a loop was closed.
class ThreadedExecutor : public Executor {
 public:
  ThreadedExecutor(const Config& config, const Camera& camera, const AtlasState& known,
                   std::shared_ptr<MapListener> listener)
      : options_(config.system),
        tracking_(config, camera),
        owner_(config, camera, cell_, known, std::move(listener)),
        requests_(queue_capacity),
        background_([this] { requests_.try_push({}); }) {
    worker_ = std::thread([this] { work(); });
  }
  ~ThreadedExecutor() override { stop_worker(); }

  std::optional<TrackedFrame> track(const RgbdFrame& frame) override {
    if (stopped_) return std::nullopt;
    rethrow_worker_failure();
    if (!options_.realtime) wait_for_mapper(frame.timestamp_s);
    if (stopped_) return std::nullopt;
    TrackedFrame result = tracking_.track(frame, cell_.take());
    if (result.keyframe_request) {
      if (!options_.realtime) unfinished_.push_back(frame.timestamp_s);
      requests_.push({result.keyframe_request, 0, nullptr, nullptr});
    }
    // Nothing can be tracked before a map's first keyframe stands.
    if (result.status == TrackStatus::initialised) cell_.wait_for_inserted(tracking_.requested());
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

  void stop() override {
    stopped_ = true;
    requests_.close();
    cell_.close();
    background_.give_up();
  }

  SnapshotCell::Content content() const override { return cell_.take(); }
  std::vector<MapState> maps() const override {
    const std::lock_guard lock(owner_mutex_);
    return owner_.maps();
  }
  std::int64_t backlog() const override { return tracking_.requested() - cell_.take().inserted; }
  double waited_s() const override { return waited_s_; }
  std::vector<const SpanRecorder*> spans() const override {
    std::vector<const SpanRecorder*> all = lanes(tracking_, owner_);
    all.push_back(&background_.spans());
    return all;
  }
  Schedule schedule() const override { return {tracking_.frames(), owner_.edits()}; }

 private:
  // Far above what the keyframe policy lets wait, so that a push never blocks at camera pace.
  static constexpr std::size_t queue_capacity = 64;

  // A keyframe to make, or what was found in the image of one. Nothing of these wakes the worker to look at the adjustment;
  // where the queue is full, it will look anyway.
  struct Work {
    std::shared_ptr<const KeyframeRequest> request;
    std::int64_t frame = 0;
    std::shared_ptr<const LabelGrid> labels;
    std::shared_ptr<const MarkerDetections> markers;
  };

  void work() {
    give_way(5);
    try {
      while (const auto work = requests_.pop()) {
        if (stopped_) break;
        do_work(*work);
      }
      adjust_to_the_end();
      const std::lock_guard lock(owner_mutex_);
      owner_.end_run([this] { return stopped_.load(); });
    } catch (const std::bad_alloc&) {
      failure_ = std::current_exception();  // says what it is
      requests_.close();
    } catch (const std::exception& error) {
      // Whatever it was, it was not the frame the tracker is at: it must not look like bad input of that frame.
      failure_ = std::make_exception_ptr(std::runtime_error(std::string("mapping failed: ") + error.what()));
      requests_.close();
    }
    background_.work_on(nullptr, 0);
    cell_.close();
  }

  void do_work(const Work& work) {
    const std::lock_guard lock(owner_mutex_);
    if (work.labels && owner_.label(work.frame, *work.labels)) owner_.interpret_planes();
    if (work.markers) owner_.mark(work.frame, *work.markers);
    if (work.request)
      owner_.work_on(*work.request, [this] { return cut_short(); }, [this] { return stopped_.load(); });
    adjust_beside();
  }

  // With the owner's mutex held.
  void adjust_beside() {
    bool finished = false;
    if (const auto wanted = owner_.adjustment())
      owner_.adjust_guarded([&] { finished = background_.has_finished(wanted); });
    if (finished) owner_.finish_adjustment();
    background_.work_on(owner_.adjustment(), owner_.newest_frame());
  }

  void adjust_to_the_end() {
    while (owner_.adjustment() && !stopped_) {
      background_.wait();
      const std::lock_guard lock(owner_mutex_);
      adjust_beside();
    }
  }

  // At the camera's pace, a window's adjustment gives way to the keyframes that wait. Otherwise tracking waits for it, so
  // that accuracy does not hang on how fast the machine is.
  bool cut_short() const { return stopped_ || (options_.realtime && requests_.size() >= 2); }

  // As far as a camera would have let mapping come: at its pace, what a keyframe brings about is done some frames later.
  // Otherwise a sequence of few frames per second would be tracked on a map that is always a long way behind.
  void wait_for_mapper(double now_s) {
    while (!unfinished_.empty() && unfinished_.front() < now_s - options_.max_lag_s) unfinished_.pop_front();
    const std::int64_t needed = tracking_.requested() - std::ssize(unfinished_);
    if (cell_.take().completed >= needed) return;
    const auto begin = std::chrono::steady_clock::now();
    cell_.wait_for_completed(needed);
    waited_s_ = waited_s_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
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
  mutable std::mutex owner_mutex_;  // held by the worker for one piece of work at a time, and by maps()
  MapOwner owner_;
  BoundedQueue<Work> requests_;
  BackgroundAdjustment background_;
  std::exception_ptr failure_;
  std::atomic<bool> stopped_ = false;
  std::deque<double> unfinished_;     // timestamps of requests that need not be completed yet
  std::atomic<double> waited_s_ = 0;  // read by others
  std::thread worker_;
};

}  // namespace

std::unique_ptr<Executor> make_threaded_executor(const Config& config, const Camera& camera,
                                                 const AtlasState& known,
                                                 std::shared_ptr<MapListener> listener) {
  return std::make_unique<ThreadedExecutor>(config, camera, known, std::move(listener));
}

}  // namespace vsgraphs
