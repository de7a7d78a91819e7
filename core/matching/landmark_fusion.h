// Seeing that two landmarks are one: landmarks of neighbouring keyframes are looked for in each other's images.
// After ORB-SLAM (Mur-Artal, Montiel, Tardos, T-RO 2015, section VI-C), with depth as a second witness.
#pragma once

#include <vector>

#include "core/geometry/camera.h"
#include "core/map/draft.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

// Looks for the landmarks of `neighbours` among the keyframe's features that have none yet.
void observe_neighbours_landmarks(const Camera& camera, const ScalePyramid& pyramid, KeyframeId keyframe,
                                  const std::vector<KeyframeId>& neighbours, Draft& draft);

// Looks for the keyframe's landmarks in each neighbour's image: a free feature becomes an observation; a feature
// that has another landmark at the same place in space merges the two, the better observed one stays.
void fuse_into_neighbours(const Camera& camera, const ScalePyramid& pyramid, KeyframeId keyframe,
                          const std::vector<KeyframeId>& neighbours, Draft& draft);

}  // namespace vsgraphs
