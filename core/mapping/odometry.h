// Odometry as measured: for each keyframe that local mapping is done with, where it stands as seen from the one before it,
// and how well that is known, from what they and their neighbours in time saw. The map's poses are only where the solver
// starts: nothing that a loop, a join or an adjustment made of them is read.
#pragma once

#include "core/map/draft.h"
#include "core/solve/window.h"

namespace vsgraphs {

// The step of a keyframe; one without `before` where neither enough landmarks that both saw nor a tracked link tie it to the
// keyframe before it. The keyframe must live. Cost: a joint problem of at most six keyframes, about a millisecond.
OdometryStep measure_step(const Map& map, KeyframeId keyframe, const MeasurementModel& model);

// Records the steps of keyframes older than `newest` that have none yet and are no longer free in `window`: the newest
// ones, four at most, so that a map which was away, or came from a file, does not hold up the mapper.
void measure_odometry(const MeasurementModel& model, const Window& window, KeyframeId newest, Draft& draft);

}  // namespace vsgraphs
