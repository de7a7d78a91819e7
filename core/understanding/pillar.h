// Pillars: upright things that a segmenter called a pillar or a column, put together from the faces that were seen.
#pragma once

#include "core/understanding/element_kind.h"

namespace vsgraphs {

ElementKind pillar_kind();

}  // namespace vsgraphs
