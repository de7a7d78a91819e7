// Which followers (core/map/follower.h) a map has.
#pragma once

#include "core/geometry/camera.h"
#include "core/map/follower.h"
#include "core/system/config/config.h"

namespace vsgraphs {

// Of an empty map; of a run of this mode.
Followers make_followers(const Config& config, const Camera& camera);

}  // namespace vsgraphs
