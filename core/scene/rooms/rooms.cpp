#include "core/scene/rooms/rooms.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace vsgraphs {
namespace {

// A room as long and as wide as a rectangle of the same area and perimeter.
bool is_corridor(double area_m2, double perimeter_m, const RoomOptions& options) {
  const double half = 0.5 * perimeter_m;
  const double root = std::sqrt(std::max(0.0, half * half - 4 * area_m2));
  const double width = 0.5 * (half - root), length = 0.5 * (half + root);
  return width <= options.corridor_width_m && length >= options.corridor_aspect * width;
}

std::vector<double> heights_inside(const SceneFace& face, const Polygon2& polygon, double low_m,
                                   double high_m) {
  std::vector<double> heights;
  for (const Eigen::Vector3f& p : face.points)
    if (p.z() >= low_m && p.z() <= high_m && contains(polygon, p.head<2>().cast<double>()))
      heights.push_back(p.z());
  return heights;
}

bool square_to_walls(const SceneFace& face, const std::vector<PlaneId>& walls,
                     std::span<const SceneFace> wall_faces, double max_tilt_deg) {
  const double limit = std::sin(max_tilt_deg * std::numbers::pi / 180);
  return std::all_of(wall_faces.begin(), wall_faces.end(), [&](const SceneFace& wall) {
    return !std::binary_search(walls.begin(), walls.end(), wall.id) ||
           std::abs(wall.plane.normal.dot(face.plane.normal)) <= limit;
  });
}

struct Level {
  PlaneId id;
  double height_m = 0;  // median of the points between the walls
  std::size_t points = 0;
};

// The faces with points between the room's walls, within a range of heights.
std::vector<Level> levels_between_walls(std::span<const SceneFace> candidates, const FoundRoom& room,
                                        std::span<const SceneFace> wall_faces, double low_m, double high_m,
                                        double max_tilt_deg) {
  std::vector<Level> levels;
  for (const SceneFace& face : candidates) {
    if (!square_to_walls(face, room.walls, wall_faces, max_tilt_deg)) continue;
    std::vector<double> heights = heights_inside(face, room.polygon, low_m, high_m);
    if (heights.empty()) continue;
    const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
    std::nth_element(heights.begin(), middle, heights.end());
    levels.push_back({face.id, *middle, heights.size()});
  }
  return levels;
}

void add_ground_and_ceiling(const SceneFaces& faces, const RoomOptions& options, FoundRoom& room) {
  constexpr double ground_reach_m = 0.9, lowest_ceiling_m = 1.8, highest_ceiling_m = 6.0;
  const double storey_m = room.ground_m;
  const auto fewer_points = [](const Level& a, const Level& b) { return a.points < b.points; };
  const auto grounds = levels_between_walls(faces.grounds, room, faces.walls, storey_m - ground_reach_m,
                                            storey_m + ground_reach_m, options.max_ground_tilt_deg);
  const auto ground = std::max_element(grounds.begin(), grounds.end(), fewer_points);
  if (ground != grounds.end()) {
    room.ground = ground->id;
    room.ground_m = ground->height_m;
    room.centroid.z() = ground->height_m;
  }

  // Not the ceiling of a higher storey, whose own ground is seen above the same walls.
  const double low = storey_m + lowest_ceiling_m;
  double high = storey_m + highest_ceiling_m;
  for (const Level& above :
       levels_between_walls(faces.grounds, room, faces.walls, low, high, options.max_ground_tilt_deg))
    high = std::min(high, above.height_m);
  auto ceilings =
      levels_between_walls(faces.ceilings, room, faces.walls, low, high, options.max_ground_tilt_deg);
  if (ceilings.empty()) return;
  // The lowest one that is more than a patch.
  const std::size_t most = std::max_element(ceilings.begin(), ceilings.end(), fewer_points)->points;
  std::erase_if(ceilings, [&](const Level& level) { return 5 * level.points < most; });
  const auto ceiling = std::min_element(ceilings.begin(), ceilings.end(), [](const Level& a, const Level& b) {
    return a.height_m < b.height_m;
  });
  room.ceiling = ceiling->id;
  room.height_m = ceiling->height_m - room.ground_m;
}

FoundRoom room_from(const RoomOutline& outline, const Cluster& cluster, double ground_m,
                    std::span<const WallLine> walls, const RoomOptions& options) {
  FoundRoom room;
  std::set<PlaneId> ids;
  for (const std::size_t w : outline.walls) ids.insert(walls[w].id());
  room.walls.assign(ids.begin(), ids.end());
  room.polygon = outline.polygon();
  room.ground_m = ground_m;
  room.area_m2 = signed_area(room.polygon);
  room.centroid << centroid(room.polygon), ground_m;
  room.kind = is_corridor(room.area_m2, outline.perimeter_m, options) ? RoomKind::corridor : RoomKind::room;
  room.closed_share = outline.closed_m / outline.perimeter_m;
  room.partial = room.closed_share < options.min_closed_share ||
                 outline.solid_m < options.min_solid_share * outline.perimeter_m;
  room.visited = cluster.visited;
  return room;
}

bool is_room(const RoomOutline& outline, const Cluster& cluster, const RoomOptions& options) {
  if (outline.edges.size() < 3 || static_cast<int>(outline.walls.size()) < options.min_walls) return false;
  if (signed_area(outline.polygon()) < options.min_area_m2) return false;
  return cluster.visited || outline.closed_m >= options.unvisited_closed_share * outline.perimeter_m;
}

}  // namespace

RoomsOfLevel find_rooms(const LevelMap& map, const Clusters& clusters, std::span<const WallLine> walls,
                        const SceneFaces& faces, const RoomOptions& options,
                        const OutlineOptions& outline_options) {
  RoomsOfLevel found;
  found.room_of_cluster.assign(clusters.clusters.size(), -1);
  for (int c = 0; c < static_cast<int>(clusters.clusters.size()); ++c) {
    const auto near = walls_around(c, map, clusters, walls, outline_options);
    if (static_cast<int>(near.size()) < options.min_walls) continue;
    const RoomOutline outline = outline_room(c, map, clusters, walls, near, outline_options);
    const Cluster& cluster = clusters.clusters[static_cast<std::size_t>(c)];
    if (!is_room(outline, cluster, options)) continue;
    found.room_of_cluster[static_cast<std::size_t>(c)] = static_cast<int>(found.rooms.size());
    found.rooms.push_back(room_from(outline, cluster, map.ground_m, walls, options));
    add_ground_and_ceiling(faces, options, found.rooms.back());
  }
  return found;
}

}  // namespace vsgraphs
