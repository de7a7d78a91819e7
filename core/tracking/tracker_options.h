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
        "search radius around predicted points of the last frame, in pixels");
  field("local_search_radius_px", o.local_search_radius_px, 1.0, 50.0,
        "search radius around projected landmarks of the local map, in pixels");
  field("local_keyframes", o.local_keyframes, 2, 200,
        "number of keyframes whose landmarks a frame is matched against");
  field("min_inliers", o.min_inliers, 6, 200, "least number of inlier matches that make a pose");
  field("few_inliers", o.few_inliers, 0, 1000,
        "with fewer inlier matches than this, the frame's depth is aligned with a keyframe's as well");
  field("enough_inliers", o.enough_inliers, 6, 1000,
        "a pose with this many inlier matches is kept even where depth alignment fails or contradicts it");
  field("min_features_to_start", o.min_features_to_start, 20, 5000,
        "least number of features with depth that start a map");
  field("max_speed_m_per_s", o.max_speed_m_per_s, 0.1, 100.0,
        "a pose that implies a higher speed than this, in metres per second, is rejected");
  field("max_turn_rad_per_s", o.max_turn_rad_per_s, 0.1, 100.0,
        "a pose that implies a faster turn than this, in radians per second, is rejected");
  field("max_velocity_change_m_per_s", o.max_velocity_change_m_per_s, 0.1, 100.0,
        "a pose that implies a larger change of velocity between two frames, in metres per second, is "
        "rejected");
  field("max_turn_change_rad_per_s", o.max_turn_change_rad_per_s, 0.1, 100.0,
        "a pose that implies a larger change of turn rate between two frames, in radians per second, is "
        "rejected");
  field("coast_s", o.coast_s, 0.0, 5.0,
        "time for which the predicted pose is used when nothing is measured, in seconds");
  field("coast_frames", o.coast_frames, 0, 100,
        "least number of frames for which the predicted pose is used when nothing is measured");
  field("new_map_after_s", o.new_map_after_s, 0.0, 3600.0,
        "a lost camera that sees enough and recognises nothing for this long, in seconds, starts a new map");
}

}  // namespace vsgraphs
