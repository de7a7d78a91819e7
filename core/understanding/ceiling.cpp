#include "core/understanding/ceiling.h"

#include <limits>

namespace vsgraphs {
namespace {

// Of the room's longest side.
Eigen::Vector3d direction_of(const Polygon2& outline) {
  Eigen::Vector2d longest = Eigen::Vector2d::UnitX();
  double most_m = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d side = outline[(i + 1) % outline.size()] - outline[i];
    if (side.norm() <= most_m) continue;
    most_m = side.norm();
    longest = side / most_m;
  }
  return {longest.x(), longest.y(), 0};
}

// A plane may be the ceiling of several rooms: each has its own, over its outline.
FoundElement ceiling_of(const FoundRoom& room) {
  FoundElement ceiling;
  ceiling.along = direction_of(room.polygon);
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(ceiling.along);
  constexpr double far = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(far, far), high(-far, -far);
  for (const Eigen::Vector2d& corner : room.polygon) {
    const Eigen::Vector3d p(corner.x(), corner.y(), 0);
    const Eigen::Vector2d laid(p.dot(ceiling.along), p.dot(across));
    low = low.cwiseMin(laid);
    high = high.cwiseMax(laid);
  }
  const Eigen::Vector2d middle = 0.5 * (low + high), size = high - low;
  ceiling.size_m = {size.x(), size.y(), 0};
  ceiling.centre = middle.x() * ceiling.along + middle.y() * across +
                   (room.ground_m + *room.height_m) * Eigen::Vector3d::UnitZ();
  ceiling.planes = {room.ceiling};
  ceiling.rooms = {room.number};
  return ceiling;
}

std::vector<FoundElement> find_ceilings(const ElementSights& sights) {
  std::vector<FoundElement> found;
  for (const FoundRoom& room : sights.structure.rooms)
    if (room.ceiling.valid() && room.height_m && !room.polygon.empty()) found.push_back(ceiling_of(room));
  return found;
}

}  // namespace

// Nearer to each other than any wall is thick.
ElementKind ceiling_kind() { return {"ceiling", 0.05, false, &find_ceilings}; }

}  // namespace vsgraphs
