// What a landmark looks like, summed up from the keyframes that observe it.
#pragma once

#include <optional>

#include "core/map/map.h"

namespace vsgraphs {

// Empty if no living keyframe observes it. Distance and level are those of the oldest observation.
std::optional<Appearance> summarise_appearance(const Map& map, const Landmark& landmark);

}  // namespace vsgraphs
