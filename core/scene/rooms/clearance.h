// Distance from every open cell to the nearest that is not.
#pragma once

#include <vector>

#include "core/scene/rooms/grid.h"

namespace vsgraphs {

// Exact Euclidean distances between cell centres, m; 0 where `passable` is 0. Outside the frame nothing is passable.
// Linear in cells: Felzenszwalb, Huttenlocher, "Distance Transforms of Sampled Functions", Theory of Computing 2012.
GridValues<float> clearance_field(const GridFrame& frame, const GridValues<char>& passable);

}  // namespace vsgraphs
