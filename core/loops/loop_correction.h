// What a verified loop does to the map: the drift is spread over the pose graph, everything moves with the keyframes it hangs
// on, and what was mapped twice becomes one.
#pragma once

#include <vector>

#include "core/base/options.h"
#include "core/loops/loop_alignment.h"
#include "core/loops/loop_checks.h"
#include "core/loops/loop_graph.h"
#include "core/map/carry.h"
#include "core/map/draft.h"
#include "core/solve/pose_graph.h"

namespace vsgraphs {

struct LoopCorrectionOptions {
  int iterations = 30;
  double negligible_m = 0.01;
  double negligible_deg = 0.3;
};

template <typename Visitor>
void describe(LoopCorrectionOptions& o, Visitor& field) {
  field("iterations", o.iterations, 1, 500,
        "iterations of the pose graph that spreads a loop's correction over the keyframes");
  field("negligible_m", o.negligible_m, 0.0, 1.0,
        "a loop that corrects less than this, in metres, moves no keyframe; its landmarks are merged");
  field("negligible_deg", o.negligible_deg, 0.0, 45.0,
        "a loop that turns by less than this, in degrees, moves no keyframe; its landmarks are merged");
}

// The pose graph's optimum with the loop in it. The oldest keyframe stays.
Corrections spread_correction(const Map& map, const KeyframeGraph& graph, const LoopAlignment& loop,
                              KeyframeId place, const LoopCorrectionOptions& options, SolveReport& report);

// Moves keyframes and all that is anchored to them (core/map/carry.h).
void move_map(const Corrections& corrections, Draft& draft);

// What the keyframe sees of the place becomes one with what it had made of it itself.
void join_sights(const LoopAlignment& loop, Draft& draft);

// Planes seen from `here` that coincide with planes seen from `there` become one; the older one stays.
void merge_coinciding_planes(const std::vector<KeyframeId>& here, const std::vector<KeyframeId>& there,
                             const LoopCheckOptions& options, Draft& draft);

}  // namespace vsgraphs
