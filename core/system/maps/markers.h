// A marker detector's answer for one image.
#pragma once

#include <vector>

#include "core/understanding/marker_placing.h"

namespace vsgraphs {

using MarkerDetections = std::vector<MarkerDetection>;

// Throws InputError, which names the marker, for sizes that are not positive, poses that are no finite rigid transforms and
// covariances that are not finite, symmetric and positive definite.
void check_markers(const MarkerDetections& detections);

}  // namespace vsgraphs
