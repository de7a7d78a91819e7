// Everything that is known, as values: what a saved atlas holds and what a run can start from.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/map/follower.h"
#include "core/vision/place_keeper.h"

namespace vsgraphs {

// One map with what was derived from it and costs time to derive again. Never changed once made.
struct MapState {
  Snapshot map;
  Followers followers;  // some or all of what follows it

  // Null where it was not kept.
  std::shared_ptr<const PlaceIndex> places() const {
    const auto* keeper = followers.find<PlaceKeeper>();
    return keeper ? keeper->places() : nullptr;
  }
};

// One saved file, by what is in it: the numbers say nothing but whether two are the same. Zeros: none.
struct AtlasVersion {
  std::uint64_t lineage = 0;   // the revision of the first file that it goes back to, from run to run
  std::uint64_t revision = 0;  // of this file
  bool operator==(const AtlasVersion&) const = default;
};

// Maps that are not joined (yet), each in a world of its own. Ids are disjoint: one id names one thing in one of them.
struct AtlasState {
  std::vector<MapState> maps;  // oldest first; the last one is being worked on
  AtlasVersion loaded;  // the file that they were loaded from, or that the run started from which made them
};

}  // namespace vsgraphs
