#include "core/understanding/ceiling.h"

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
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& corner : room.polygon)
    corners.emplace_back(corner.x(), corner.y(), room.ground_m + *room.height_m);
  enclose(corners, direction_of(room.polygon), ceiling);
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
