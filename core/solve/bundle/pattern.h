// Which blocks the reduced system of a joint problem has.
#pragma once

#include "core/solve/bundle/dense_part.h"
#include "core/solve/bundle/landmark_part.h"

namespace vsgraphs {

// Builds `pattern` from what the two parts tie together, and binds the landmarks to it.
void build_pattern(const VariableOrder& order, const DensePart& dense, LandmarkPart& landmarks,
                   BlockMatrix& pattern);

}  // namespace vsgraphs
