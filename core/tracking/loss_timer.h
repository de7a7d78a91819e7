// When a track that is not measured any more counts as lost, and when a lost camera starts a new map. Times are those of the
// frames; there is no clock.
#pragma once

#include <optional>

#include "core/tracking/tracker_options.h"

namespace vsgraphs {

class LossTimer {
 public:
  explicit LossTimer(const TrackerOptions& options) : options_(options) {}

  bool lost() const { return lost_; }
  // A pose was measured at that time.
  void measured(double timestamp_s) {
    lost_ = false;
    searching_since_s_.reset();
    last_measured_s_ = timestamp_s;
    unmeasured_frames_ = 0;
  }
  // One more frame without a measurement: may its pose still be predicted?
  bool coasts(double timestamp_s) {
    ++unmeasured_frames_;
    return timestamp_s - last_measured_s_ <= options_.coast_s || unmeasured_frames_ <= options_.coast_frames;
  }
  void lose() { lost_ = true; }
  // A lost frame that sees enough to start a map with recognised nothing: has that gone on for long enough? What was seen
  // without being recognised counts, not time in the dark.
  bool searched_in_vain(double timestamp_s) {
    if (!searching_since_s_) searching_since_s_ = timestamp_s;
    return timestamp_s - *searching_since_s_ >= options_.new_map_after_s;
  }

 private:
  TrackerOptions options_;
  double last_measured_s_ = 0;
  int unmeasured_frames_ = 0;
  bool lost_ = false;
  std::optional<double> searching_since_s_;
};

}  // namespace vsgraphs
