// Places: a sparse graph of points with free space around them, each in its room. (The place layer of Hughes, Chang,
// Carlone, "Hydra", RSS 2022, here on the ground plan; edges as in Toussaint, "The relative neighbourhood graph of a finite planar set", Pattern Recognition
// 1980.)
#pragma once

#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/map/structure.h"
#include "core/scene/rooms/clusters.h"
#include "core/scene/rooms/rooms.h"

namespace vsgraphs {

struct PlaceOptions {
  double min_clearance_m = 0.2;
  double spacing_m = 0.6;
};

template <typename Visitor>
void describe(PlaceOptions& o, Visitor& field) {
  field("min_clearance_m", o.min_clearance_m, 0.05, 1.0,
        "least free space around a place of the graph of places, in metres");
  field("spacing_m", o.spacing_m, 0.2, 5.0,
        "least distance between two places of the graph of places, in metres");
}

// Widest places first, and one in each doorway. Neighbours see each other over free ground.
std::vector<Place> find_places(const LevelMap& map, const Clusters& clusters, const RoomsOfLevel& rooms,
                               const PlaceOptions& options);

}  // namespace vsgraphs
