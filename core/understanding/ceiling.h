// Ceilings: of each room where one was seen, over the room's outline.
#pragma once

#include "core/understanding/element_kind.h"

namespace vsgraphs {

ElementKind ceiling_kind();

}  // namespace vsgraphs
