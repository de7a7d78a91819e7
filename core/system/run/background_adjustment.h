// The thread on which the whole map is adjusted beside tracking and mapping.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <thread>

#include "core/loops/loop_adjustment.h"
#include "core/system/maps/span_recorder.h"

namespace vsgraphs {

class BackgroundAdjustment {
 public:
  // `done` is called on the adjustment's thread when it has run to its end or failed; it must not wait for who calls work_on().
  explicit BackgroundAdjustment(std::function<void()> done)
      : done_(std::move(done)), spans_("full adjustment") {}
  ~BackgroundAdjustment() { stop(); }
  BackgroundAdjustment(const BackgroundAdjustment&) = delete;
  BackgroundAdjustment& operator=(const BackgroundAdjustment&) = delete;

  // The adjustment wanted from here on; null: none. Another one that was under way is stopped between two iterations, or when it
  // has been set up: waits for that. `frame`: that the timeline names.
  void work_on(const std::shared_ptr<FullAdjustment>& wanted, std::int64_t frame);
  // Whether `adjustment` is the one worked on and has run. Rethrows what made it fail.
  bool has_finished(const std::shared_ptr<FullAdjustment>& adjustment) const;
  // Until the one worked on has run, or was given up.
  void wait();
  // Any thread: the one under way comes to its end between two iterations, without a result. Does not wait for that.
  void give_up() { stop_ = true; }

  // Not while one is under way.
  const SpanRecorder& spans() const { return spans_; }

 private:
  void run(FullAdjustment& adjustment);
  void stop();

  std::function<void()> done_;
  SpanRecorder spans_;
  std::shared_ptr<FullAdjustment> current_;
  std::atomic<bool> stop_ = false, finished_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace vsgraphs
