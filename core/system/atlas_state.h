// Everything that is known, as values: what a saved atlas holds and what a run can start from.
#pragma once

#include <memory>
#include <vector>

#include "core/map/map.h"
#include "core/scene/free_space.h"
#include "core/vision/place_index.h"

namespace vsgraphs {

// One map with what was derived from it and costs time to derive again. Never changed once made.
struct MapState {
  Snapshot map;
  std::shared_ptr<const PlaceIndex> places;
  std::shared_ptr<const FreeSpace> free_space;  // none where rooms are not sought
};

// Maps that are not joined (yet), each in a world of its own. Ids are disjoint: one id names one thing in one of them.
struct AtlasState {
  std::vector<MapState> maps;  // oldest first; the last one is being worked on
};

}  // namespace vsgraphs
