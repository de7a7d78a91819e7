// The planes of a window: which take part, and what is known of them.
#pragma once

#include "core/solve/window.h"

namespace vsgraphs {

// Every plane that a free keyframe of the window sees and that more than one keyframe has seen becomes a variable. What
// keyframes of the window saw of it is a factor each; what all others saw is condensed into one prior, weakened by the
// error their poses may have; of other stretches some speak for all. A retired keyframe's share goes with its anchor.
void build_plane_factors(const Map& map, const Window& window, const MeasurementModel& model,
                         WindowProblem& problem);

// Walls stand upright on the ground they belong to: the nearest below them in the window. Roll and pitch depend on it.
void build_wall_to_ground_factors(const Map& map, const Window& window, const MeasurementModel& model,
                                  WindowProblem& problem);

// Planes that one free keyframe alone has seen move with it.
void move_passenger_planes(const WindowProblem& problem, const Corrections& corrections, Draft& draft);

}  // namespace vsgraphs
