// An edit worked out on an old version of the map, said anew for the version it meets.
#pragma once

#include "core/map/map.h"

namespace vsgraphs {

// A keyframe goes to where the edit put it, with what has happened to it since added in its own frame; landmarks,
// planes and markers that the edit moved are taken along in the frame of the first keyframe that observed them, their own
// changes on both sides added up. What was made since is carried by the correction of the keyframe it hangs on (tracked link, else
// most shared landmarks). Ids that were merged away are followed, those that vanished drop out.
//
// If nothing has happened since, the edit is returned as it is. The edit may move, merge, remove, observe and classify; it
// must not add keyframes, landmarks, planes or markers, as their ids may have been given away (throws InvariantError).
// Cost: linear in the map and the edit.
MapEdit rebase(const MapEdit& edit, const Map& old_map, const Map& now);

}  // namespace vsgraphs
