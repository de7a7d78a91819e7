#include "core/scene/rooms/room_numbers.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <vector>

namespace vsgraphs {
namespace {

constexpr double same_ground_m = 0.8;  // a storey is higher; drift along the vertical is less
constexpr double enough_likeness = 0.3;

struct Bounds {
  Eigen::Vector2d low, high;
};

Bounds bounds_of(const Polygon2& polygon) {
  Bounds b{polygon[0], polygon[0]};
  for (const Eigen::Vector2d& p : polygon) {
    b.low = b.low.cwiseMin(p);
    b.high = b.high.cwiseMax(p);
  }
  return b;
}

// Shared area as a share of the smaller one, on a raster.
double overlap_share(const FoundRoom& a, const FoundRoom& b) {
  constexpr double raster_m = 0.2;
  const FoundRoom& small = a.area_m2 <= b.area_m2 ? a : b;
  const FoundRoom& large = a.area_m2 <= b.area_m2 ? b : a;
  const Bounds bounds = bounds_of(small.polygon), other = bounds_of(large.polygon);
  if ((bounds.low.array() > other.high.array()).any() || (bounds.high.array() < other.low.array()).any())
    return 0;
  int inside = 0, shared = 0;
  for (double y = bounds.low.y() + 0.5 * raster_m; y < bounds.high.y(); y += raster_m)
    for (double x = bounds.low.x() + 0.5 * raster_m; x < bounds.high.x(); x += raster_m) {
      if (!contains(small.polygon, {x, y})) continue;
      ++inside;
      shared += contains(large.polygon, {x, y});
    }
  return inside ? static_cast<double>(shared) / inside : 0;
}

double shared_walls(const FoundRoom& a, const FoundRoom& b) {
  std::vector<PlaneId> shared;
  std::set_intersection(a.walls.begin(), a.walls.end(), b.walls.begin(), b.walls.end(),
                        std::back_inserter(shared));
  const std::size_t most = std::max(a.walls.size(), b.walls.size());
  return most ? static_cast<double>(shared.size()) / static_cast<double>(most) : 0;
}

}  // namespace

void number_rooms(std::span<const FoundRoom> previous, std::span<FoundRoom> rooms, RoomNumber& next_number) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // (-likeness, previous, new)
  for (std::size_t p = 0; p < previous.size(); ++p)
    for (std::size_t r = 0; r < rooms.size(); ++r) {
      if (std::abs(previous[p].ground_m - rooms[r].ground_m) > same_ground_m) continue;
      const double likeness =
          0.5 * (overlap_share(previous[p], rooms[r]) + shared_walls(previous[p], rooms[r]));
      if (likeness >= enough_likeness) pairs.emplace_back(-likeness, p, r);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<char> given(previous.size(), 0);
  for (FoundRoom& room : rooms) room.number = no_room;
  for (const auto& [likeness, p, r] : pairs) {
    if (given[p] || rooms[r].number != no_room) continue;
    rooms[r].number = previous[p].number;
    given[p] = 1;
  }
  for (FoundRoom& room : rooms)
    if (room.number == no_room) room.number = next_number++;
}

}  // namespace vsgraphs
