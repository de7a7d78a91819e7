#include "core/tracking/keyframe_policy.h"

namespace vsgraphs {

bool keyframe_wanted(const KeyframePolicyOptions& o, const KeyframeEvidence& e) {
  if (e.held_by_surfaces) {
    return e.backlog < 3 &&
           (e.translation_m >= o.surface_translation_m || e.rotation_rad >= o.surface_rotation_rad);
  }
  const bool moved = e.translation_m >= o.min_translation_m || e.rotation_rad >= o.min_rotation_rad;
  if (!moved) return false;
  const double share =
      e.reference_landmarks > 0 ? static_cast<double>(e.tracked) / e.reference_landmarks : 0.0;
  const bool weak = share < 0.5 * o.min_tracked_share || e.tracked < 50;
  // A busy mapper is only interrupted by need.
  if (e.backlog >= 3) return false;
  if (e.backlog >= 1) return weak;
  const bool hungry = e.tracked_close < o.few_close_points && e.untracked_close > o.many_new_close_points;
  return share < o.min_tracked_share || hungry || e.seconds_since_last >= o.max_interval_s;
}

}  // namespace vsgraphs
