// Where a grid of voxels stands that several keyframes carved, once these have been corrected: as a whole, so that only what was
// bent within it must be carved again.
#pragma once

#include <span>

#include "core/scene/space/free_space.h"

namespace vsgraphs {

struct CarvedView {
  Se3 grid_from_camera;   // as it was carved
  Se3 level_from_camera;  // as it is now
  bool frozen = false;    // cannot be carved again
};

// `present`, as long as no more than `tolerated` views, none of them frozen, are off by more than the options allow: those are to be
// carved again. Else the placement at which the fewest are, among identity and those of up to nine views spread over all, if that
// is less than half as many; an even choice goes to the first.
Se3 placement_of(std::span<const CarvedView> views, const Se3& present, int tolerated,
                 const FreeSpaceOptions& options);

}  // namespace vsgraphs
