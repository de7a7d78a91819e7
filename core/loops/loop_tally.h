// What became of all the places that keyframes were compared with: how often each verdict was given, and which refused ones
// came nearest to a loop. For people who wonder why a loop was not closed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/loops/loop_closer.h"
#include "core/map/map.h"

namespace vsgraphs {

// A place that looked like another one and was refused, in numbers.
struct RefusedLoop {
  LoopVerdict verdict = LoopVerdict::none_similar;
  std::int64_t frame = 0, place_frame = 0;  // of the two keyframes
  double timestamp_s = 0, place_timestamp_s = 0;
  double score = 0;
  int inliers = 0, supporters = 0;
  double off_m = 0, off_rad = 0;  // what the loop would have moved the keyframe by
  double drift_sigmas = 0;        // 0 where it was refused before drift was asked
  double disagreeing_share = 0;   // of the surface seen from both sides
  double seen_through_share = 0;  // of either side's surfaces, where the other one looked through
};

struct LoopTally {
  static constexpr std::size_t most_nearest = 10;

  std::array<std::int64_t, loop_verdict_count> verdicts{};  // candidates, by LoopVerdict
  std::vector<RefusedLoop> nearest;  // those that passed most checks first, then those of more inliers

  // `report` as close() or join() left it; `here` and `there` hold its two keyframes. Cost: none that grows.
  void add(const LoopReport& report, const Map& here, const Map& there);
};

}  // namespace vsgraphs
