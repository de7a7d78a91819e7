#include "core/understanding/window.h"

#include <algorithm>

namespace vsgraphs {
namespace {

std::vector<FoundElement> find_windows(const ElementSights& sights) {
  constexpr double smallest_m = 0.2, inside_m = 0.3;
  std::vector<FoundElement> found;
  sights.map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    if (plane.role != SurfaceRole::window) return;
    FoundElement window = element_of(sights, id, inside_m);
    if (std::min(window.size_m.x(), window.size_m.z()) >= smallest_m) found.push_back(std::move(window));
  });
  return found;
}

}  // namespace

// Two sashes of one window are nearer; two windows beside each other have wall between them.
ElementKind window_kind() { return {"window", 0.25, true, &find_windows}; }

}  // namespace vsgraphs
