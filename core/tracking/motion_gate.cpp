#include "core/tracking/motion_gate.h"

namespace vsgraphs {

namespace {

constexpr double slack_m = 0.1, slack_rad = 0.15;

}  // namespace

MotionGate::MotionGate(const TrackerOptions& options, const Se3& world_from_last, double seconds,
                       const std::optional<Se3>& predicted)
    : world_from_last_(world_from_last),
      predicted_(predicted),
      step_{options.max_speed_m_per_s * seconds + slack_m, options.max_turn_rad_per_s * seconds + slack_rad},
      surprise_{options.max_velocity_change_m_per_s * seconds + slack_m,
                options.max_turn_change_rad_per_s * seconds + slack_rad} {}

bool MotionGate::Reach::holds(const Se3& from, const Se3& to) const {
  const Se3 step = from.inverse() * to;
  return step.translation().norm() <= way_m && rotation_angle(step.rotation()) <= turn_rad;
}

bool MotionGate::passes(const Se3& world_from_now) const {
  if (!world_from_now.finite() || !step_.holds(world_from_last_, world_from_now)) return false;
  return !predicted_ || surprise_.holds(*predicted_, world_from_now);
}

}  // namespace vsgraphs
