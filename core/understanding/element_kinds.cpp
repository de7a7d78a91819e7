// The kinds of elements there are; a line each.
#include "core/understanding/element_kind.h"

namespace vsgraphs {

std::span<const ElementKind> element_kinds() {
  static const std::vector<ElementKind> kinds{};
  return kinds;
}

}  // namespace vsgraphs
