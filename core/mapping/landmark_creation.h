// New landmarks for a new keyframe: from its depth where there is any, by triangulation where there is none.
#pragma once

#include <vector>

#include "core/geometry/camera.h"
#include "core/map/draft.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

// A landmark for every feature with depth that has none yet. Returns what was made, in feature order.
std::vector<LandmarkId> create_from_depth(const Camera& camera, KeyframeId keyframe, Draft& draft);

// Landmarks for features without depth that match a neighbour's along the epipolar line and triangulate well
// (parallax at least 1 deg, reprojection within the 95 % gate in both views).
std::vector<LandmarkId> create_by_triangulation(const Camera& camera, const ScalePyramid& pyramid,
                                                KeyframeId keyframe,
                                                const std::vector<KeyframeId>& neighbours, Draft& draft);

}  // namespace vsgraphs
