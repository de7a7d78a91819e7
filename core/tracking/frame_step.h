// The step from the last frame that had a pose to the one being tracked, in the map that holds the last. Borrows all it
// names: it lives as long as one frame is worked on.
#pragma once

#include "core/map/map.h"
#include "core/tracking/frame_state.h"
#include "core/tracking/last_frame.h"
#include "core/tracking/motion_gate.h"

namespace vsgraphs {

struct FrameStep {
  const Map& map;
  const LastFrame& last;  // found in `map`
  const FrameState& now;
  double seconds;   // between the two
  Se3 predicted;    // world_from_camera of `now` by the motion model
  MotionGate gate;  // from `last` to `now`
};

}  // namespace vsgraphs
