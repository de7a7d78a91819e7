// How a map is turned so that its plumb line is z.
#pragma once

#include "core/map/map.h"

namespace vsgraphs {

// Turns the map's `up`, which it must know, to z, about the world's origin. Where rooms were sought before it turns from their
// level frame the shortest way: a map that began with the camera looking straight down would otherwise spin about the plumb line
// with every small correction of `up`.
Se3 levelling(const Map& map);

}  // namespace vsgraphs
