// Rooms and floors in a window: what their walls owe one another, and where their nodes stand.
#pragma once

#include "core/solve/window.h"

namespace vsgraphs {

// Walls of one room that are nearly parallel or nearly at right angles are held to it; the pairs of a kind share the weight
// of one (the paper's 1/N). The room's node follows the walls, the floor's node its rooms.
void build_room_factors(const Map& map, const Window& window, const MeasurementModel& model,
                        WindowProblem& problem);

}  // namespace vsgraphs
