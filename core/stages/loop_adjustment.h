// The joint problem over the whole map, for the background after a loop: in slices, so that whoever runs it can stop between
// two iterations, look whether the map has moved on, and go on or give up.
#pragma once

#include <functional>

#include "core/map/draft.h"
#include "core/solve/window.h"

namespace vsgraphs {

// Every keyframe but the oldest free, every landmark in.
Window whole_map(const Map& map);

class FullAdjustment {
 public:
  // `settle_iterations`: done before outliers are dropped. Memory: about 100 bytes per observation.
  FullAdjustment(Snapshot snapshot, const MeasurementModel& model, int settle_iterations = 5);

  // Does at most `iterations` more; `stop` is asked before each. False when there is nothing left to gain or it was told to
  // stop. Cost per iteration: linear in the observations, and the sparse factorisation of the keyframes.
  bool advance(int iterations, const std::function<bool()>& stop = {});

  int iterations() const { return iterations_; }
  const SolveReport& report() const { return report_; }  // of the last slice
  // What it has come to so far, based on the snapshot it was given; see rebase() if the map has moved on.
  MapEdit edit() const;

 private:
  void drop_outliers();

  Snapshot snapshot_;
  Window window_;
  WindowProblem problem_;
  std::vector<std::pair<LandmarkId, KeyframeId>> dropped_;
  SolveReport report_;
  int settle_iterations_;
  int iterations_ = 0;
  bool settled_ = false;
};

}  // namespace vsgraphs
