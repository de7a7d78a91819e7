#include "core/system/run/background_adjustment.h"

#include "core/system/run/thread_priority.h"

namespace vsgraphs {

void BackgroundAdjustment::work_on(const std::shared_ptr<FullAdjustment>& wanted, std::int64_t frame) {
  if (wanted == current_) return;
  stop();
  current_ = wanted;
  if (!current_) return;
  stop_ = finished_ = false;
  failure_ = nullptr;
  spans_.set_frame(frame);
  thread_ = std::thread([this] { run(*current_); });
}

void BackgroundAdjustment::run(FullAdjustment& adjustment) {
  give_way(10);  // mapping, which the camera waits for sooner, goes first
  try {
    if (!adjustment.run([this] { return stop_.load(); }, &spans_)) return;
  } catch (...) {
    failure_ = std::current_exception();
  }
  finished_ = true;
  done_();
}

bool BackgroundAdjustment::has_finished(const std::shared_ptr<FullAdjustment>& adjustment) const {
  if (!adjustment || adjustment != current_ || !finished_) return false;
  if (failure_) std::rethrow_exception(failure_);
  return true;
}

void BackgroundAdjustment::wait() {
  if (thread_.joinable()) thread_.join();
}

void BackgroundAdjustment::stop() {
  stop_ = true;
  wait();
}

}  // namespace vsgraphs
