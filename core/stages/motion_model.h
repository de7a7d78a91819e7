// Where the camera should be now: constant velocity, and how far it can have gone.
#pragma once

#include <algorithm>
#include <optional>

#include "core/geometry/se3.h"

namespace vsgraphs {

class MotionModel {
 public:
  // Constant velocity from the last two known poses, scaled by time; the last pose where only one is known.
  // Extrapolates over half a second at the most.
  Se3 predict(const Se3& world_from_last, double seconds) const {
    if (!twist_per_s_) return world_from_last;
    return world_from_last.retract(*twist_per_s_ * std::min(seconds, max_extrapolation_s));
  }

  void update(const Se3& world_from_previous, const Se3& world_from_now, double seconds) {
    if (seconds <= 0) return;
    twist_per_s_ = (world_from_previous.inverse() * world_from_now).log() / seconds;
  }
  void forget() { twist_per_s_.reset(); }
  bool known() const { return twist_per_s_.has_value(); }

 private:
  // Beyond this a straight extrapolation is worth less than standing still.
  static constexpr double max_extrapolation_s = 0.5;
  std::optional<Vector6d> twist_per_s_;
};

}  // namespace vsgraphs
