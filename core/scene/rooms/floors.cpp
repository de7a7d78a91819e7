#include "core/scene/rooms/floors.h"

#include <algorithm>
#include <set>

namespace vsgraphs {
namespace {

FoundFloor floor_of(std::span<const FoundRoom* const> rooms) {
  FoundFloor floor;
  std::set<PlaneId> grounds;
  for (const FoundRoom* room : rooms) {
    floor.rooms.push_back(room->number);
    floor.extent.push_back(room->polygon);
    floor.ground_m += room->ground_m / static_cast<double>(rooms.size());
    floor.centroid += room->centroid / static_cast<double>(rooms.size());
    if (room->ground.valid()) grounds.insert(room->ground);
  }
  floor.grounds.assign(grounds.begin(), grounds.end());
  return floor;
}

}  // namespace

std::vector<FoundFloor> find_floors(std::span<const FoundRoom> rooms, const FloorOptions& options) {
  std::vector<const FoundRoom*> sorted;
  for (const FoundRoom& room : rooms) sorted.push_back(&room);
  std::sort(sorted.begin(), sorted.end(), [](const FoundRoom* a, const FoundRoom* b) {
    return a->ground_m != b->ground_m ? a->ground_m < b->ground_m : a->number < b->number;
  });
  std::vector<FoundFloor> floors;
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t end = first + 1;
    // Measured from the lowest: a flight of small steps must not chain storeys together.
    while (end < sorted.size() && sorted[end]->ground_m - sorted[first]->ground_m <= options.tolerance_m)
      ++end;
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(first),
              sorted.begin() + static_cast<std::ptrdiff_t>(end),
              [](const FoundRoom* a, const FoundRoom* b) { return a->number < b->number; });
    floors.push_back(floor_of(std::span(sorted).subspan(first, end - first)));
    first = end;
  }
  return floors;
}

}  // namespace vsgraphs
