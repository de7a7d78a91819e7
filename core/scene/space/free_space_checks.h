// Whether free space that was read can be that of a map.
#pragma once

#include "core/map/map_checks.h"
#include "core/scene/space/free_space.h"

namespace vsgraphs {

// What is wrong, in a few words; nullptr if all is well. Linear in the views' samples and the blocks.
Wrong wrong_with_free_space(const FreeSpace& space, const Map& map);
// Of itself, whatever map it is of.
Wrong wrong_with_free_space(const FreeSpace& space);

}  // namespace vsgraphs
