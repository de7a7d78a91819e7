// Where the camera should be now: constant velocity, and how far it can have gone.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/principal_axes.h"
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

  // `information`: what was measured of the pose (tangent on its right). In directions it hardly knows the pose is a
  // prediction, and taking that for a measurement would let the velocity wander off by itself: there the old velocity
  // dies down instead.
  void update(const Se3& world_from_previous, const Se3& world_from_now, double seconds,
              const Matrix6d& information) {
    if (seconds <= 0) return;
    const Vector6d measured = (world_from_previous.inverse() * world_from_now).log() / seconds;
    const Vector6d fading = std::exp(-seconds / fading_s) * twist_per_s_.value_or(Vector6d::Zero());
    twist_per_s_ = measured + weak_directions(information, weak_sigma) * (fading - measured);
  }
  void forget() { twist_per_s_.reset(); }
  bool known() const { return twist_per_s_.has_value(); }

 private:
  // Beyond this a straight extrapolation is worth less than standing still.
  static constexpr double max_extrapolation_s = 0.5;
  static constexpr double fading_s = 5.0, weak_sigma = 0.03;  // m or rad
  std::optional<Vector6d> twist_per_s_;
};

}  // namespace vsgraphs
