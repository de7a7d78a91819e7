// An edit worked out on an old version of the map, said anew for the version it meets.
#pragma once

#include <vector>

#include "core/map/map.h"

namespace vsgraphs {

// What the edit moved stands where the edit put it: it weighed the whole map, and what was worked out since for parts of it, on
// the ground of the old one, gives way (added up, the two would correct one error twice). Landmarks, planes and markers follow the
// first keyframe that observed them and lives on. What was made since is carried by the correction of the
// keyframe it is anchored to (tracked link, else most shared landmarks). Ids that were merged away are followed, those that
// vanished drop out; rooms that were found or moved since stay where they are.
//
// `moved`, by keyframe index, is what loops have moved keyframes by since, world from world (empty: nothing): what the edit put
// somewhere it would have put there. If nothing has happened since, the edit is returned as it is. The edit may move, merge, remove, observe and classify; it
// must not add keyframes, landmarks, planes or markers, as their ids may have been given away (throws InvariantError).
// Cost: linear in the map and the edit.
MapEdit rebase(const MapEdit& edit, const Map& old_map, const Map& now, const std::vector<Se3>& moved = {});

}  // namespace vsgraphs
