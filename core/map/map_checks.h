// Whether a map that was read can be one: what every reader of a map relies on, and what `Map::apply` never breaks.
#pragma once

#include "core/map/map.h"

namespace vsgraphs {

// What is wrong, in a few words; nullptr if all is well. Linear in the map.
using Wrong = const char*;

// Every id leads to what it names, and where two name each other, both do.
Wrong wrong_with_references(const Map& map);
// Every number is one, and within what a map can hold (core/geometry/bounds.h).
Wrong wrong_with_values(const Map& map);
bool is_sane(const DepthGrid& grid);

}  // namespace vsgraphs
