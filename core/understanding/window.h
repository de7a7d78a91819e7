// Windows in walls: upright surfaces that a segmenter called so, each with the room that it is seen from. (The window of keyframes that
// an adjustment moves is another thing: core/solve/window.h.)
#pragma once

#include "core/understanding/element_kind.h"

namespace vsgraphs {

ElementKind window_kind();

}  // namespace vsgraphs
