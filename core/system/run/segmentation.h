// A segmenter's answer for one image, and what of it the map keeps.
#pragma once

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/map/label_grid.h"

namespace vsgraphs {

// Borrowed for the length of one call.
struct Segmentation {
  ImageView<std::uint8_t> roles;  // values of SurfaceRole
  ImageView<float> confidence;
  ImageView<std::uint16_t> instances;
};

// The label nearest to each sample of the camera's depth grids. Throws InputError for sizes that differ and values
// that are no roles or no confidences.
LabelGrid sample_labels(const Segmentation& segmentation, const Camera& camera);

}  // namespace vsgraphs
