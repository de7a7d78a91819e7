#include "core/scene/rooms.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

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

// The face with most points between the room's walls, within a range of heights; the median of their heights.
std::pair<PlaneId, double> face_between_walls(std::span<const SceneFace> candidates, const FoundRoom& room,
                                              std::span<const SceneFace> wall_faces, double low_m,
                                              double high_m, double max_tilt_deg) {
  PlaneId best;
  std::vector<double> best_heights;
  for (const SceneFace& face : candidates) {
    if (!square_to_walls(face, room.walls, wall_faces, max_tilt_deg)) continue;
    std::vector<double> heights = heights_inside(face, room.polygon, low_m, high_m);
    if (heights.size() <= best_heights.size()) continue;
    best = face.id;
    best_heights = std::move(heights);
  }
  if (best_heights.empty()) return {PlaneId{}, 0};
  const auto middle = best_heights.begin() + static_cast<std::ptrdiff_t>(best_heights.size() / 2);
  std::nth_element(best_heights.begin(), middle, best_heights.end());
  return {best, *middle};
}

void add_ground_and_ceiling(const SceneFaces& faces, const RoomOptions& options, FoundRoom& room) {
  constexpr double same_ground_m = 0.3, lowest_ceiling_m = 1.8, highest_ceiling_m = 6.0;
  const double z = room.ground_m;
  room.ground = face_between_walls(faces.grounds, room, faces.walls, z - same_ground_m, z + same_ground_m,
                                   options.max_ground_tilt_deg)
                    .first;
  const auto [ceiling, height] = face_between_walls(faces.ceilings, room, faces.walls, z + lowest_ceiling_m,
                                                    z + highest_ceiling_m, options.max_ground_tilt_deg);
  room.ceiling = ceiling;
  if (ceiling.valid()) room.height_m = height - z;
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
  room.partial = room.closed_share < options.min_closed_share;
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
