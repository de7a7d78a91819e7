// The kinds of elements there are; a line each.
#include "core/understanding/ceiling.h"
#include "core/understanding/element_kind.h"
#include "core/understanding/pillar.h"
#include "core/understanding/window.h"

namespace vsgraphs {

std::span<const ElementKind> element_kinds() {
  static const std::vector<ElementKind> kinds{
      ceiling_kind(),
      window_kind(),
      pillar_kind(),
  };
  return kinds;
}

}  // namespace vsgraphs
