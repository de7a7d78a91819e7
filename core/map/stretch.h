// A stretch: a run of keyframes, about a room of way, that ordinary matches tie to one another rigidly. It has a frame of its
// own, its first keyframe's camera, and is named by that keyframe. What is derived from what the keyframes saw is held per
// stretch and in its frame, so that a loop, which moves stretches against each other, leaves it as it is.
#pragma once

#include <span>

#include "core/map/map.h"

namespace vsgraphs {

// Metres of way after which another stretch begins.
inline constexpr double usual_stretch_m = 15.0;
// Landmarks that a keyframe must share with a stretch to be tied to it by them.
inline constexpr int stretch_tie = 15;

// Where the stretch's frame stands; empty if there is no such stretch.
std::optional<Se3> world_from_stretch(const Map& map, KeyframeId stretch);

// The stretch that goes on where a keyframe at `world_from_camera` is made next, which observes `landmarks` and may be linked to
// another: the newest keyframe's, unless nothing ties the two or the way is too long. Invalid: another begins.
// Cost: the observations of the landmarks and the keyframes of the stretch.
KeyframeId stretch_going_on(const Map& map, const Se3& world_from_camera,
                            std::span<const LandmarkId> landmarks, const std::optional<TrackedLink>& link,
                            double max_way_m);

}  // namespace vsgraphs
