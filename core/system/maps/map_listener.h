// Is told of what happens to the maps while a run goes on: for programs that react to it.
#pragma once

#include "core/loops/loop_closer.h"
#include "core/map/map.h"

namespace vsgraphs {

// Two places that look alike were compared.
struct LoopDecision {
  LoopReport report;      // of the candidate that came furthest: its two keyframes, its verdict and why
  bool accepted = false;  // a loop is closed, or two maps become one
  bool of_maps = false;   // the place is in another map than the one worked on
};

// Each function is called on the thread that maps, right after the edit it tells of: what takes long in it holds up mapping. None may
// call track(), finish() or atlas_state() of the Slam that calls. After an exception nothing more is told, and a warning says so.
class MapListener {
 public:
  virtual ~MapListener() = default;
  // `map` holds it.
  virtual void keyframe_made(KeyframeId /*keyframe*/, const Snapshot& /*map*/) {}
  // A room that was not there before; `map`'s structure holds it.
  virtual void room_found(RoomNumber /*room*/, const Snapshot& /*map*/) {}
  // Before what was accepted is done. `map`: the one worked on.
  virtual void loop_decided(const LoopDecision& /*decision*/, const Snapshot& /*map*/) {}
};

}  // namespace vsgraphs
