// The markers of a window: which take part, and what is known of them.
#pragma once

#include "core/solve/window.h"

namespace vsgraphs {

// Every marker that a free keyframe of the window sees and that more than one keyframe has seen becomes a variable, unless
// it was seen in two places. What keyframes of the window saw of it is a factor each; what all others saw are priors that
// share the weight of one, weakened by the error their poses may have. A retired keyframe's share goes with its anchor.
void build_marker_factors(const Map& map, const Window& window, const MeasurementModel& model,
                          WindowProblem& problem);

// Markers that are no variables move with the first keyframe that saw them, where that is free.
void move_passenger_markers(const WindowProblem& problem, const Corrections& corrections, Draft& draft);

}  // namespace vsgraphs
