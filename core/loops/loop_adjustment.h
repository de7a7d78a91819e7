// The joint problem over the whole map, for the background after a loop: worked out on the map as it was when it was asked
// for, while the map moves on; rebase() says the result anew for the map it meets.
#pragma once

#include <functional>

#include "core/base/trace.h"
#include "core/map/draft.h"
#include "core/solve/window.h"

namespace vsgraphs {

// Every keyframe but the oldest free, every landmark in.
Window whole_map(const Map& map);

// Made on one thread, run on another, taken back by the first.
class FullAdjustment {
 public:
  FullAdjustment(Snapshot snapshot, const MeasurementModel& model,
                 const BundleOptions& options = {.max_iterations = 5, .iterations_before_dropping = 5});

  // Once. `stop` is asked before each iteration; false, and nothing to show for it, where it said so. Cost per iteration:
  // linear in the observations, and the sparse factorisation of the keyframes. Memory: about 100 bytes per observation.
  bool run(const std::function<bool()>& stop = {}, TraceSink* trace = nullptr);

  const Map& base() const { return *snapshot_; }  // the map it was asked for
  int iterations() const { return report_.iterations; }
  // What it came to, based on base(). After run().
  const MapEdit& edit() const { return edit_; }

 private:
  Snapshot snapshot_;
  MeasurementModel model_;
  BundleOptions options_;
  SolveReport report_;
  MapEdit edit_;
};

}  // namespace vsgraphs
