#include "core/scene/rooms/structure.h"

#include <algorithm>
#include <set>

#include "core/scene/rooms/room_numbers.h"

namespace vsgraphs {
namespace {

// Everything one storey needs until rooms have their numbers.
struct Storey {
  LevelMap map;
  Clusters clusters;
  RoomsOfLevel rooms;
};

// Cameras held above this ground and below the next one.
std::vector<Eigen::Vector2d> cameras_above(const SpaceView& space, double ground_m) {
  constexpr double lowest_m = 0.2, highest_m = 2.2;
  std::vector<Eigen::Vector2d> cameras;
  for (const FreeSpace::View& view : space.views) {
    const Eigen::Vector3d& at = view.level_from_camera.translation();
    if (at.z() > ground_m + lowest_m && at.z() < ground_m + highest_m) cameras.push_back(at.head<2>());
  }
  return cameras;
}

Storey look_at_storey(const SpaceView& space, double ground_m, const SceneFaces& faces,
                      const StructureOptions& options) {
  Storey storey;
  storey.map = build_level_map(space.voxels, space.voxel_m, ground_m, faces.walls, options.level);
  const std::vector<WallLine> walls = wall_lines(faces.walls, ground_m, options.level);
  storey.clusters =
      find_clusters(storey.map, walls, cameras_above(space, ground_m), options.cluster, options.opening);
  storey.rooms = find_rooms(storey.map, storey.clusters, walls, faces, options.room, options.outline);
  return storey;
}

// Numbers run over all storeys, so that a room is matched with one of its own height wherever the storeys were found.
void number_all(std::vector<Storey>& storeys, const FoundStructure& previous, RoomNumber& next_number) {
  std::vector<FoundRoom> rooms;
  for (const Storey& storey : storeys)
    rooms.insert(rooms.end(), storey.rooms.rooms.begin(), storey.rooms.rooms.end());
  number_rooms(previous.rooms, rooms, next_number);
  std::size_t i = 0;
  for (Storey& storey : storeys)
    for (FoundRoom& room : storey.rooms.rooms) room = rooms[i++];
}

void add_neighbours(FoundStructure& found) {
  for (FoundRoom& room : found.rooms) {
    std::set<RoomNumber> neighbours;
    for (const FoundDoor& door : found.doors)
      for (const int side : {0, 1})
        if (door.rooms[static_cast<std::size_t>(side)] == room.number)
          neighbours.insert(door.rooms[static_cast<std::size_t>(1 - side)]);
    room.neighbours.assign(neighbours.begin(), neighbours.end());
  }
}

void add_places(const Storey& storey, const PlaceOptions& options, std::vector<Place>& places) {
  const auto first = static_cast<std::uint32_t>(places.size());
  for (Place& place : find_places(storey.map, storey.clusters, storey.rooms, options)) {
    for (std::uint32_t& neighbour : place.neighbours) neighbour += first;
    places.push_back(std::move(place));
  }
}

}  // namespace

FoundStructure recognise_structure(const SpaceView& space, const SceneFaces& faces,
                                   const FoundStructure& previous, const StructureOptions& options) {
  std::vector<Storey> storeys;
  for (const double ground_m : level_heights(faces.grounds, options.level))
    storeys.push_back(look_at_storey(space, ground_m, faces, options));
  FoundStructure found;
  found.next_number = previous.next_number;
  number_all(storeys, previous, found.next_number);
  for (const Storey& storey : storeys) {
    found.rooms.insert(found.rooms.end(), storey.rooms.rooms.begin(), storey.rooms.rooms.end());
    const auto doors = find_doors(storey.map, storey.clusters, storey.rooms, space.views, options.door);
    found.doors.insert(found.doors.end(), doors.begin(), doors.end());
    add_places(storey, options.place, found.places);
  }
  add_neighbours(found);
  found.floors = find_floors(found.rooms, options.floor);
  return found;
}

}  // namespace vsgraphs
