#include "core/understanding/ceiling.h"

#include <algorithm>

namespace vsgraphs {
namespace {

std::vector<FoundElement> find_ceilings(const ElementSights& sights) {
  constexpr double smallest_m2 = 0.5, inside_m = 1.0;
  std::vector<FoundElement> found;
  sights.map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    if (plane.role != SurfaceRole::ceiling) return;
    FoundElement ceiling = element_of(sights, id, inside_m);
    if (ceiling.size_m.x() * ceiling.size_m.y() < smallest_m2) return;
    // A large one covers rooms that its middle is not above.
    for (const FoundRoom& room : sights.structure.rooms)
      if (room.ceiling == id) ceiling.rooms.push_back(room.number);
    std::sort(ceiling.rooms.begin(), ceiling.rooms.end());
    ceiling.rooms.erase(std::unique(ceiling.rooms.begin(), ceiling.rooms.end()), ceiling.rooms.end());
    found.push_back(std::move(ceiling));
  });
  return found;
}

}  // namespace

ElementKind ceiling_kind() { return {"ceiling", 0.25, false, &find_ceilings}; }

}  // namespace vsgraphs
