#include "core/solve/window_structure.h"

#include <algorithm>

#include "core/solve/factors/floor_centroid.h"
#include "core/solve/factors/plane_parallel.h"
#include "core/solve/factors/plane_perpendicular.h"
#include "core/solve/factors/room_centroid.h"
#include "core/solve/structure_gate.h"

namespace vsgraphs {
namespace {

// The room's walls that are variables of the problem.
std::vector<int> walls_in(const FoundRoom& room, const WindowProblem& problem) {
  std::vector<int> walls;
  for (const PlaneId id : room.walls) {
    const auto at = std::find(problem.plane_of_variable.begin(), problem.plane_of_variable.end(), id);
    if (at != problem.plane_of_variable.end())
      walls.push_back(static_cast<int>(at - problem.plane_of_variable.begin()));
  }
  return walls;
}

using Pairs = std::vector<std::pair<int, int>>;

template <typename Factor>
void hold(const Pairs& pairs, WindowProblem& problem) {
  const PlaneAngle angle{PlaneAngle{}.sigma_rad, std::max(1, static_cast<int>(pairs.size()))};
  for (const auto& [a, b] : pairs) problem.bundle.factors.push_back(std::make_unique<Factor>(a, b, angle));
}

void hold_angles(const std::vector<int>& walls, const FactorSwitches& factors, WindowProblem& problem) {
  constexpr AngleGate gate;
  Pairs parallel, perpendicular;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    for (std::size_t j = i + 1; j < walls.size(); ++j) {
      const auto& a = problem.bundle.structures.planes[static_cast<std::size_t>(walls[i])].normal;
      const auto& b = problem.bundle.structures.planes[static_cast<std::size_t>(walls[j])].normal;
      if (gate.holds(false, deviation_from_parallel_rad(a, b))) parallel.emplace_back(walls[i], walls[j]);
      if (gate.holds(false, deviation_from_perpendicular_rad(a, b)))
        perpendicular.emplace_back(walls[i], walls[j]);
    }
  }
  if (factors.plane_parallel) hold<PlaneParallel>(parallel, problem);
  if (factors.plane_perpendicular) hold<PlanePerpendicular>(perpendicular, problem);
}

// Only where all of the room's walls take part: the mean of some of them is another point.
void tie_node(const Map& map, std::size_t room_index, const std::vector<int>& walls, WindowProblem& problem) {
  const FoundRoom& room = map.structure().rooms[room_index];
  if (walls.empty() || walls.size() != room.walls.size()) return;
  std::vector<WallOfRoom> members;
  for (const int wall : walls) {
    const PlaneId id = problem.plane_of_variable[static_cast<std::size_t>(wall)];
    members.push_back({wall, map.observed_centre(*map.planes().find(id))});
  }
  const int node = static_cast<int>(problem.bundle.structures.centroids.size());
  problem.bundle.structures.centroids.push_back(map.structure().room_nodes[room_index]);
  problem.room_of_centroid.push_back(static_cast<int>(room_index));
  problem.bundle.factors.push_back(std::make_unique<RoomCentroid>(node, members));
}

void tie_floors(const Map& map, WindowProblem& problem) {
  const FoundStructure& structure = map.structure();
  for (std::size_t f = 0; f < structure.floors.size(); ++f) {
    std::vector<int> rooms;
    for (std::size_t i = 0; i < problem.room_of_centroid.size(); ++i) {
      const RoomNumber number = structure.rooms[static_cast<std::size_t>(problem.room_of_centroid[i])].number;
      const auto& members = structure.floors[f].rooms;
      if (std::find(members.begin(), members.end(), number) != members.end())
        rooms.push_back(static_cast<int>(i));
    }
    if (rooms.empty() || rooms.size() != structure.floors[f].rooms.size()) continue;
    const int node = static_cast<int>(problem.bundle.structures.centroids.size());
    problem.bundle.structures.centroids.push_back(structure.floor_nodes[f]);
    problem.floor_of_centroid.emplace_back(node, static_cast<int>(f));
    problem.bundle.factors.push_back(std::make_unique<FloorCentroid>(node, rooms));
  }
}

}  // namespace

void build_room_factors(const Map& map, const Window&, const MeasurementModel& model,
                        WindowProblem& problem) {
  for (std::size_t i = 0; i < map.structure().rooms.size(); ++i) {
    const std::vector<int> walls = walls_in(map.structure().rooms[i], problem);
    hold_angles(walls, model.factors, problem);
    // A node without its factor would be a variable that nothing holds.
    if (model.factors.room_centroid) tie_node(map, i, walls, problem);
  }
  if (model.factors.floor_centroid) tie_floors(map, problem);
}

}  // namespace vsgraphs
