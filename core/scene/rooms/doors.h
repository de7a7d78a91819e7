// Doors and passages: the openings between two rooms, measured by the rays that went through them. (Beyond the paper.)
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/map/structure.h"
#include "core/scene/rooms/clusters.h"
#include "core/scene/rooms/rooms.h"
#include "core/scene/space/free_space.h"

namespace vsgraphs {

struct DoorOptions {
  int min_rays = 3;
  double behind_m = 0.15;
  double range_m = 5.0;
  int max_keyframes = 40;
};

template <typename Visitor>
void describe(DoorOptions& o, Visitor& field) {
  field("min_rays", o.min_rays, 1, 100,
        "number of rays through a strip of 5 cm that make it part of an opening");
  field("behind_m", o.behind_m, 0.02, 1.0,
        "a ray passed a wall if it ended this far behind the wall, in metres");
  field("range_m", o.range_m, 1.0, 20.0,
        "largest distance from a keyframe to a door that it measures, in metres");
  field("max_keyframes", o.max_keyframes, 1, 1000, "largest number of keyframes that measure one door");
}

// Doors between two different rooms. Costs about 0.1 ms per door and keyframe that measures it.
std::vector<FoundDoor> find_doors(const LevelMap& map, const Clusters& clusters, const RoomsOfLevel& rooms,
                                  std::span<const FreeSpace::View> views, const DoorOptions& options);

}  // namespace vsgraphs
