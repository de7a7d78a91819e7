// Ceilings: level surfaces above the cameras that saw them, each with the rooms that it covers.
#pragma once

#include "core/understanding/element_kind.h"

namespace vsgraphs {

ElementKind ceiling_kind();

}  // namespace vsgraphs
