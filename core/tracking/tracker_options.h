// What tracking as a whole can be told; each of its classes takes what it needs.
#pragma once

#include "core/base/options.h"
#include "core/tracking/keyframe_policy.h"
#include "core/tracking/recovery.h"

namespace vsgraphs {

struct TrackerOptions {
  double search_radius_px = 15;
  double local_search_radius_px = 5;
  int local_keyframes = 20;
  int min_inliers = 20;
  int few_inliers = 120;
  int enough_inliers = 40;
  int min_features_to_start = 100;
  double max_speed_m_per_s = 3.0;
  double max_turn_rad_per_s = 5.0;
  double max_velocity_change_m_per_s = 1.2;
  double max_turn_change_rad_per_s = 2.5;
  double coast_s = 0.4;
  int coast_frames = 3;
  double new_map_after_s = 2.0;
  KeyframePolicyOptions keyframe;
  RecoveryOptions recovery;
};

template <typename Visitor>
void describe(TrackerOptions& o, Visitor& field) {
  field("search_radius_px", o.search_radius_px, 2.0, 200.0,
        "search around predicted points of the last frame");
  field("local_search_radius_px", o.local_search_radius_px, 1.0, 50.0, "search around projected landmarks");
  field("local_keyframes", o.local_keyframes, 2, 200, "keyframes whose landmarks a frame is matched against");
  field("min_inliers", o.min_inliers, 6, 200, "fewer inlier matches than this are no pose");
  field("few_inliers", o.few_inliers, 0, 1000,
        "with fewer inlier matches than this, depth is aligned with a keyframe's as well");
  field("enough_inliers", o.enough_inliers, 6, 1000,
        "a pose with this many inlier matches stands even where depth alignment fails or contradicts it");
  field("min_features_to_start", o.min_features_to_start, 20, 5000,
        "features with depth needed to start a map");
  field("max_speed_m_per_s", o.max_speed_m_per_s, 0.1, 100.0,
        "a pose that would need more speed is rejected");
  field("max_turn_rad_per_s", o.max_turn_rad_per_s, 0.1, 100.0,
        "a pose that would need a faster turn is rejected");
  field("max_velocity_change_m_per_s", o.max_velocity_change_m_per_s, 0.1, 100.0,
        "a pose that would need a larger change of velocity from one frame to the next is rejected");
  field("max_turn_change_rad_per_s", o.max_turn_change_rad_per_s, 0.1, 100.0,
        "a pose that would need a larger change of turn rate from one frame to the next is rejected");
  field("coast_s", o.coast_s, 0.0, 5.0, "how long the motion model is believed when nothing is measured");
  field("coast_frames", o.coast_frames, 0, 100,
        "frames for which it is believed at least, however slow they come");
  field("new_map_after_s", o.new_map_after_s, 0.0, 3600.0,
        "a lost camera that sees enough and recognises nothing for so long starts a new map");
}

}  // namespace vsgraphs
