// Worlds that are no tidy row of rooms: what is found in them is right or missing, never invented.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene/rooms/test_buildings.h"

namespace vsgraphs {
namespace {

using test::TestBuilding;
using test::TestWalk;

TEST(OddWorlds, AnOpenPlanHallIsOneRoom) {
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 13, 8)}};
  for (const double x : {4.0, 8.5}) b.boxes.push_back({{x, 4}, {0.2, 0.2}, 0, 2.6});  // pillars
  // Partitions as high as a sitting person, and a pair of lockers that leaves a door's width between it and the wall.
  b.boxes.push_back({{6.2, 1.6}, {0.03, 1.6}, 0, 1.15});
  b.boxes.push_back({{6.2, 6.3}, {1.2, 0.03}, 0, 1.15});
  b.boxes.push_back({{10.4, 1.6}, {0.25, 0.7}, 0, 1.9});
  TestWalk walk(b, 21);
  walk.walk({{2, 2}, {2, 6}, {5.2, 5.4}, {7.2, 3.4}, {9.2, 2.2}, {11.6, 2.2}, {11.4, 6}, {8, 6.6}});
  const FoundStructure found = test::recognise(walk);
  ASSERT_EQ(found.rooms.size(), 1u);
  EXPECT_GT(test::overlap(found.rooms[0].polygon, b.rooms[0].polygon), 0.95);
  EXPECT_TRUE(found.doors.empty());
}

TEST(OddWorlds, AWallOfGlassGivesNoDepthAndTheRoomEndsThere) {
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 5, 4)}};
  b.doors = {{{5, 2}, {1, 0}, 4.0, 2.7}};  // all of it; beyond, nothing within reach
  TestWalk walk(b, 22);
  walk.walk({{1.5, 1.5}, {3.5, 2.5}});
  const FoundStructure found = test::recognise(walk);
  ASSERT_EQ(found.rooms.size(), 1u);
  EXPECT_GT(test::overlap(found.rooms[0].polygon, b.rooms[0].polygon), 0.9);
  EXPECT_LT(found.rooms[0].closed_share, 0.9);
  EXPECT_TRUE(found.doors.empty());
}

TEST(OddWorlds, WhereDepthIsMissingAltogetherNothingIsFound) {
  FreeSpace nothing({});
  DepthGrid blind;
  blind.columns = 80;
  blind.rows = 60;
  blind.samples.resize(4800);
  nothing.integrate(KeyframeId{0, 0}, std::make_shared<const DepthGrid>(blind), Se3{});
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 5, 4)}};
  TestWalk walk(b, 23);
  walk.walk({{1.5, 1.5}});
  const FoundStructure found = recognise_structure(nothing, walk.faces(), {}, {});
  EXPECT_TRUE(found.rooms.empty());
  EXPECT_TRUE(found.floors.empty());
}

TEST(OddWorlds, AFlightOfStairsJoinsTwoFloorsAndMakesNone) {
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 6, 4), 0, 5.4}, {test::rectangle(6.12, 0, 10, 4), 2.8}};
  b.doors = {{{6.06, 3.2}, {1, 0}, 0.9, 2.05, 2.8}};
  constexpr int steps = 16;
  for (int i = 0; i < steps; ++i)  // along the far wall of the hall
    b.boxes.push_back({{1.2 + 0.24 * i, 3.3}, {0.12, 0.7}, 0, 2.8 * (i + 1) / steps});
  b.boxes.push_back({{5.5, 3.3}, {0.5, 0.7}, 2.6, 2.8});  // a landing before the door
  TestWalk walk(b, 24);
  walk.walk({{1.5, 1.2}, {3.5, 1.5}, {4.5, 1.2}});
  for (int i = 0; i <= steps; i += 2) walk.look({1.2 + 0.24 * i, 3.3}, 2.8 * i / steps, 0);
  walk.walk({{5.5, 3.2}, {6.8, 3.2}, {8, 2}}, 2.8);
  const FoundStructure found = test::recognise(walk);
  ASSERT_EQ(found.floors.size(), 2u);
  EXPECT_NEAR(found.floors[0].ground_m, 0, 0.03);
  EXPECT_NEAR(found.floors[1].ground_m, 2.8, 0.03);
  EXPECT_GT(test::best_overlap(found, b.rooms[1]), 0.9);
  const FoundRoom* hall = test::room_at(found, {3, 1.2});
  ASSERT_TRUE(hall);
  EXPECT_LT(hall->area_m2, 24.5);
  EXPECT_GT(hall->area_m2, 14);
}

}  // namespace
}  // namespace vsgraphs
