// For tests: the buildings, each with a walk through it.
#pragma once

#include "core/scene/rooms/structure.h"
#include "core/scene/rooms/test_synthetic_building.h"

namespace vsgraphs::test {

inline Polygon2 l_shape() { return {{0, 0}, {6.5, 0}, {6.5, 3.2}, {3.1, 3.2}, {3.1, 6.0}, {0, 6.0}}; }

// Two rooms and the wall between them, with a doorway in it.
inline TestBuilding two_rooms(double door_width = 0.9) {
  TestBuilding b;
  b.rooms = {{rectangle(0, 0, 4.5, 4)}, {rectangle(4.62, 0, 9, 4)}};
  b.doors = {{{4.56, 2.2}, {1, 0}, door_width}};
  return b;
}

inline TestWalk walk_two_rooms(const TestBuilding& building) {
  TestWalk walk(building, 3);
  walk.walk({{1.2, 1.2}, {3.2, 2.2}, {4.56, 2.2}, {6.2, 2.2}, {7.6, 2.4}});
  return walk;
}

// Three rooms in a row, a corridor along them, doors from each to the corridor and between the rooms.
inline TestBuilding three_rooms_and_corridor() {
  TestBuilding b;
  b.rooms = {{rectangle(0, 0, 12.24, 1.7)},
             {rectangle(0, 1.82, 4, 5.5)},
             {rectangle(4.12, 1.82, 8.12, 5.5)},
             {rectangle(8.24, 1.82, 12.24, 5.5)}};
  b.doors = {{{1.2, 1.76}, {0, 1}}, {{4.06, 4.0}, {1, 0}}, {{8.18, 3.6}, {1, 0}}, {{11.2, 1.76}, {0, 1}}};
  b.boxes = {
      {{2.6, 5.3}, {0.6, 0.2}, 0, 1.9}, {{6, 3.4}, {0.7, 0.4}, 0.7, 0.75}, {{6.0, 0.2}, {0.5, 0.2}, 0, 1.9}};
  return b;
}

inline TestWalk walk_three_rooms(const TestBuilding& building) {
  TestWalk walk(building, 4);
  walk.walk({{6.0, 0.9},
             {1.2, 0.9},
             {1.2, 2.8},
             {2.2, 3.8},
             {4.06, 4.0},
             {5.0, 4.4},
             {7.2, 4.2},
             {8.18, 3.6},
             {10.2, 3.6},
             {11.2, 3.0},
             {11.2, 0.9},
             {9.0, 0.85},
             {6.0, 0.9}});
  return walk;
}

inline FoundStructure recognise(const TestWalk& walk, const FoundStructure& previous = {}) {
  return recognise_structure(walk.free_space(), walk.faces(), previous, {});
}

// Overlap with the found room that fits best.
inline double best_overlap(const FoundStructure& found, const TestRoom& room) {
  double best = 0;
  for (const FoundRoom& f : found.rooms)
    if (std::abs(f.ground_m - room.z) < 0.3) best = std::max(best, overlap(f.polygon, room.polygon));
  return best;
}

inline const FoundRoom* room_at(const FoundStructure& found, const Eigen::Vector2d& p, double z = 0) {
  for (const FoundRoom& room : found.rooms)
    if (std::abs(room.ground_m - z) < 0.3 && contains(room.polygon, p)) return &room;
  return nullptr;
}

}  // namespace vsgraphs::test
