// Markers seen in a keyframe become part of the map. Proposes and never optimises: the next window turns sights into factors.
// After vS-Graphs, appendix I.
#pragma once

#include <span>

#include "core/map/draft.h"

namespace vsgraphs {

// A detector's answer for one marker in one image.
struct MarkerDetection {
  MarkerId id;
  double size_m = 0;  // side of the black square
  Se3 camera_from_marker;
  Matrix6d covariance = Matrix6d::Identity();  // tangent (m, rad) on the right of camera_from_marker
};

// What the keyframe, which is in the snapshot, sees, in place of what it was said to see before. A number may come twice: then
// it hangs in two places. A marker stands where most keyframes saw it. One of another size than mapped starts anew.
MapEdit place_markers(KeyframeId keyframe, std::span<const MarkerDetection> detections,
                      const Snapshot& snapshot);

}  // namespace vsgraphs
