// When a frame is worth keeping: the map around the camera is thinning out, or depth sees much the map lacks.
// Rules after ORB-SLAM2 (Mur-Artal, Tardos, T-RO 2017, section III-E), with the mapper's backlog as an input.
#pragma once

#include "core/base/options.h"

namespace vsgraphs {

struct KeyframePolicyOptions {
  double min_tracked_share = 0.85;
  double min_translation_m = 0.02;
  double min_rotation_rad = 0.035;
  double max_interval_s = 1.0;
  double surface_translation_m = 0.12;
  double surface_rotation_rad = 0.15;
  int few_close_points = 100;
  int many_new_close_points = 70;
};

template <typename Visitor>
void describe(KeyframePolicyOptions& o, Visitor& field) {
  field("min_tracked_share", o.min_tracked_share, 0.1, 1.0,
        "a keyframe is made when less than this share of the reference keyframe's landmarks is tracked");
  field("min_translation_m", o.min_translation_m, 0.0, 1.0,
        "least distance between two keyframes, in metres, unless turned by min_rotation_rad");
  field("min_rotation_rad", o.min_rotation_rad, 0.0, 1.0,
        "least angle between two keyframes, in radians, unless moved by min_translation_m");
  field("surface_translation_m", o.surface_translation_m, 0.0, 5.0,
        "distance between keyframes, in metres, where surfaces hold the pose instead of landmarks");
  field("surface_rotation_rad", o.surface_rotation_rad, 0.0, 3.2,
        "angle between keyframes, in radians, where surfaces hold the pose instead of landmarks");
  field("max_interval_s", o.max_interval_s, 0.1, 60.0,
        "longest time between two keyframes of a moving camera, in seconds");
  field("few_close_points", o.few_close_points, 0, 1000,
        "a keyframe is made when fewer points with depth than this are tracked and many_new_close_points are "
        "new");
  field("many_new_close_points", o.many_new_close_points, 0, 1000,
        "number of new points with depth that makes a keyframe when few_close_points are tracked");
}

struct KeyframeEvidence {
  int tracked = 0;                // inlier landmarks in this frame
  int reference_landmarks = 0;    // well-established landmarks of the reference keyframe
  int tracked_close = 0;          // inlier landmarks whose feature has depth
  int untracked_close = 0;        // features with depth and no landmark
  double seconds_since_last = 0;  // since the last keyframe was requested
  double translation_m = 0;       // from the last keyframe requested
  double rotation_rad = 0;
  int backlog = 0;                // keyframes waiting for the mapper
  bool held_by_surfaces = false;  // landmarks are few, depth was aligned with a keyframe's
};

bool keyframe_wanted(const KeyframePolicyOptions& options, const KeyframeEvidence& evidence);

}  // namespace vsgraphs
