// Whether an atlas that was read can be one, beyond what each map says of itself (core/map/map_checks.h).
#pragma once

#include "core/map/map_checks.h"
#include "core/system/atlas_file.h"

namespace vsgraphs {

// What is wrong, in a few words; nullptr if all is well. Linear in the atlas.
Wrong wrong_with_map_state(const MapState& state);
Wrong wrong_with_atlas(const SavedAtlas& atlas);

}  // namespace vsgraphs
