// How far a camera can have moved since the last frame. In a hand or on a robot it cannot go faster than so much, nor
// change its velocity at once: where the motion is known, a pose far from the prediction is a place that looks alike.
#pragma once

#include <optional>

#include "core/geometry/se3.h"
#include "core/tracking/tracker_options.h"

namespace vsgraphs {

class MotionGate {
 public:
  // `predicted`: world_from_camera by the motion model, where the motion is known; without it speed and turn alone decide.
  MotionGate(const TrackerOptions& options, const Se3& world_from_last, double seconds,
             const std::optional<Se3>& predicted);

  // A pose in the same world. Never for one that is not finite.
  bool passes(const Se3& world_from_now) const;

 private:
  struct Reach {
    double way_m, turn_rad;
    bool holds(const Se3& from, const Se3& to) const;
  };

  Se3 world_from_last_;
  std::optional<Se3> predicted_;
  Reach step_, surprise_;
};

}  // namespace vsgraphs
