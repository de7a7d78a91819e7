// Whether an atlas, read or about to be written, can be one.
#pragma once

#include "core/map/map_checks.h"
#include "core/system/maps/atlas_file.h"

namespace vsgraphs {

// What is wrong, in a few words; nullptr if all is well. Linear in the atlas.
Wrong wrong_with_maps(const AtlasState& state);
// Beyond that: with what belongs to the maps, and with all of them together.
Wrong wrong_with_atlas(const SavedAtlas& atlas);

}  // namespace vsgraphs
