// What a segmenter says of a keyframe's image, at the samples of its depth grid.
#pragma once

#include <cstdint>
#include <vector>

#include "core/map/surface_patch.h"

namespace vsgraphs {

struct LabelSample {
  SurfaceRole role = SurfaceRole::undecided;  // undecided: the segmenter does not say
  float confidence = 0;                       // 0..1
  std::uint16_t instance = 0;                 // 0: none; pieces of one thing share a number
};

struct LabelGrid {
  int columns = 0, rows = 0;  // those of the DepthGrid
  std::vector<LabelSample> samples;
};

}  // namespace vsgraphs
