#include "core/understanding/pillar.h"

#include <algorithm>
#include <string_view>

#include "core/map/class_votes.h"

namespace vsgraphs {
namespace {

constexpr double accepted_votes = 1.5;  // of keyframes, by confidence: more than one look

bool is_called_pillar(const MappedPlane& plane) {
  const auto most =
      std::max_element(plane.class_votes.begin(), plane.class_votes.end(),
                       [](const ClassVote& a, const ClassVote& b) { return a.weight < b.weight; });
  if (most == plane.class_votes.end() || static_cast<double>(most->weight) < accepted_votes) return false;
  constexpr std::string_view names[] = {"pillar", "column"};
  return std::any_of(std::begin(names), std::end(names),
                     [most](std::string_view name) { return most->id == class_id(name); });
}

std::vector<FoundElement> find_pillars(const ElementSights& sights) {
  constexpr double largest_m = 1.5, lowest_m = 0.8, inside_m = 0.3;
  std::vector<FoundElement> found;
  sights.map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    if (!is_called_pillar(plane)) return;
    FoundElement face = element_of(sights, id, inside_m);
    const bool upright = face.size_m.z() > lowest_m && face.size_m.y() < 0.1;
    if (upright && face.size_m.x() < largest_m) found.push_back(std::move(face));
  });
  return found;
}

}  // namespace

// Faces meet at edges that are seen to within a cell or two.
ElementKind pillar_kind() { return {"pillar", 0.3, true, &find_pillars}; }

}  // namespace vsgraphs
