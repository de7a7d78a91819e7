#include "core/scene/rooms/structure.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene/rooms/test_buildings.h"

namespace vsgraphs {
namespace {

using test::TestBuilding;
using test::TestWalk;

// One room; every wall is known, unless told otherwise.
FoundStructure found_in(const TestBuilding& building, const std::vector<Eigen::Vector2d>& way) {
  TestWalk walk(building, 1);
  walk.walk(way);
  return test::recognise(walk);
}

TEST(Structure, RectangularRoomIsFoundWithItsWallsGroundAndCeiling) {
  TestBuilding b;
  b.rooms = {{test::rectangle(1, 2, 6.2, 6.1)}};
  b.boxes = {{{1.3, 4}, {0.25, 0.9}, 0, 1.9}, {{4, 4}, {0.6, 0.4}, 0.7, 0.75}};
  TestWalk walk(b, 1);
  walk.walk({{3, 3}, {5, 5}});
  const FoundStructure found = test::recognise(walk);
  ASSERT_EQ(found.rooms.size(), 1u);
  const FoundRoom& room = found.rooms[0];
  EXPECT_GT(test::overlap(room.polygon, b.rooms[0].polygon), 0.97);
  EXPECT_EQ(room.walls, walk.walls_of(0));
  EXPECT_EQ(room.ground, walk.faces().grounds[0].id);
  ASSERT_TRUE(room.height_m);
  EXPECT_NEAR(*room.height_m, 2.6, 0.03);
  EXPECT_EQ(room.kind, RoomKind::room);
  EXPECT_TRUE(room.visited);
  EXPECT_FALSE(room.partial);
  EXPECT_NEAR(room.area_m2, 5.2 * 4.1, 0.5);
  EXPECT_NEAR((room.centroid - Eigen::Vector3d(3.6, 4.05, 0)).norm(), 0, 0.1);
  EXPECT_TRUE(found.doors.empty());
}

TEST(Structure, RoomsNeedNotBeRectangular) {
  TestBuilding trapezoid, hexagon;
  trapezoid.rooms = {{{{0, 0}, {6.4, 0}, {5.3, 4.5}, {1.0, 4.1}}}};
  hexagon.rooms = {
      {{{3.1, 0.0}, {1.55, 2.685}, {-1.55, 2.685}, {-3.1, 0.0}, {-1.55, -2.685}, {1.55, -2.685}}}};
  for (const auto& [building, way] :
       {std::pair{trapezoid, std::vector<Eigen::Vector2d>{{2, 1.5}, {4.5, 2.5}}},
        std::pair{hexagon, std::vector<Eigen::Vector2d>{{-1, 0}, {1, 0.5}}}}) {
    const FoundStructure found = found_in(building, way);
    ASSERT_EQ(found.rooms.size(), 1u);
    EXPECT_GT(test::overlap(found.rooms[0].polygon, building.rooms[0].polygon), 0.97);
    EXPECT_EQ(found.rooms[0].walls.size(), building.rooms[0].polygon.size());
  }
}

TEST(Structure, LShapedRoomStaysOneWithFurnitureAcrossItsCorners) {
  TestBuilding b;
  b.rooms = {{test::l_shape()}};
  // A tall cupboard in the outer corner, one that juts out at the inner corner, and one opposite to it that leaves
  // a passage as wide as a door.
  b.boxes = {{{0.5, 0.5}, {0.6, 0.25}, 0, 1.9, 0.785},
             {{3.45, 2.9}, {0.35, 0.3}, 0, 1.9},
             {{3.0, 0.85}, {0.5, 0.85}, 0, 1.9}};
  const TestBuilding turned = b.turned(20);
  const Eigen::Rotation2Dd turn(20 * std::numbers::pi / 180);
  const FoundStructure found =
      found_in(turned, {turn * Eigen::Vector2d(5.2, 1.6), turn * Eigen::Vector2d(3.4, 2.1),
                        turn * Eigen::Vector2d(1.6, 2.1), turn * Eigen::Vector2d(1.6, 4.6)});
  ASSERT_EQ(found.rooms.size(), 1u);
  EXPECT_GT(test::overlap(found.rooms[0].polygon, turned.rooms[0].polygon), 0.95);
  EXPECT_EQ(found.rooms[0].walls.size(), 6u);
  EXPECT_TRUE(found.doors.empty());
}

TEST(Structure, DoorwayDividesTwoRooms) {
  for (const double width : {0.7, 0.9, 1.3}) {
    const TestBuilding b = test::two_rooms(width);
    const TestWalk walk = test::walk_two_rooms(b);
    const FoundStructure found = test::recognise(walk);
    ASSERT_EQ(found.rooms.size(), 2u) << width;
    for (const test::TestRoom& room : b.rooms) EXPECT_GT(test::best_overlap(found, room), 0.97) << width;
    ASSERT_EQ(found.doors.size(), 1u) << width;
    const FoundDoor& door = found.doors[0];
    EXPECT_NEAR((door.position - Eigen::Vector3d(4.56, 2.2, 0)).norm(), 0, 0.06) << width;
    EXPECT_NEAR(door.width_m, width, 0.1);
    ASSERT_TRUE(door.height_m);
    EXPECT_NEAR(*door.height_m, 2.05, 0.1);
    EXPECT_NEAR(door.thickness_m, 0.12, 0.03);
    const FoundRoom *left = test::room_at(found, {2, 2}), *right = test::room_at(found, {7, 2});
    ASSERT_TRUE(left && right);
    // The normal leads from the first room to the second.
    const bool forward = door.normal.x() > 0;
    EXPECT_EQ(door.rooms[0], forward ? left->number : right->number);
    EXPECT_EQ(door.rooms[1], forward ? right->number : left->number);
    EXPECT_EQ(left->neighbours, std::vector<RoomNumber>{right->number});
  }
}

// Wall above a door is kept as cells whose middle may lie lower than the door's top.
TEST(Structure, WhereTheCellsOfALintelBeginChangesNothing) {
  for (const double height : {1.98, 2.05}) {
    TestBuilding b = test::two_rooms();
    b.doors[0].height = height;
    const TestWalk walk = test::walk_two_rooms(b);
    const FreeSpace free_space = walk.free_space();
    for (double phase = 0; phase < 0.1; phase += 0.02) {
      const FoundStructure found = recognise_structure(free_space, walk.faces_in_cells(phase), {}, {});
      EXPECT_EQ(found.rooms.size(), 2u) << height << ' ' << phase;
      EXPECT_EQ(found.doors.size(), 1u) << height << ' ' << phase;
    }
  }
}

TEST(Structure, AThinPostInADoorwayLeavesItOneDoor) {
  TestBuilding b = test::two_rooms();
  b.boxes = {{{4.56, 2.35}, {0.03, 0.03}, 0, 2.05}};
  const FoundStructure found = test::recognise(test::walk_two_rooms(b));
  EXPECT_EQ(found.rooms.size(), 2u);
  ASSERT_EQ(found.doors.size(), 1u);
  EXPECT_NEAR((found.doors[0].position.head<2>() - Eigen::Vector2d(4.56, 2.2)).norm(), 0, 0.1);
}

TEST(Structure, DoorLeafOpenOrHalfOpenChangesNothing) {
  for (const double degrees : {90.0, 50.0}) {
    TestBuilding b = test::two_rooms();
    // Hinged at the doorway's lower edge, opening into the second room.
    const double a = (90 - degrees) * std::numbers::pi / 180;
    const Eigen::Vector2d hinge(4.62, 1.75), leaf(std::cos(a), std::sin(a));
    b.boxes = {{hinge + 0.43 * leaf, {0.43, 0.02}, 0, 2.03, a}};
    TestWalk walk(b, 5);
    walk.walk({{1.2, 1.2}, {3.2, 2.4}, {4.56, 2.45}, {6.2, 2.8}, {7.6, 2.4}});
    const FoundStructure found = test::recognise(walk);
    ASSERT_EQ(found.rooms.size(), 2u) << degrees;
    ASSERT_EQ(found.doors.size(), 1u) << degrees;
    EXPECT_NEAR((found.doors[0].position - Eigen::Vector3d(4.56, 2.2, 0)).norm(), 0, 0.15) << degrees;
    EXPECT_NEAR(found.doors[0].width_m, 0.9, 0.25) << degrees;
  }
}

TEST(Structure, DoorInACornerIsFound) {
  TestBuilding b = test::two_rooms();
  b.doors[0].center = {4.56, 3.53};  // its upper edge 2 cm from the wall across
  TestWalk walk(b, 6);
  walk.walk({{1.2, 1.2}, {3.2, 3.4}, {4.56, 3.5}, {6.2, 3.2}, {7.6, 1.6}});
  const FoundStructure found = test::recognise(walk);
  EXPECT_EQ(found.rooms.size(), 2u);
  EXPECT_EQ(found.doors.size(), 1u);
}

TEST(Structure, CupboardNicheIsNoRoomAndItsMouthNoDoor) {
  TestBuilding b;
  b.rooms = {{{{0, 0}, {5, 0}, {5, 1.5}, {5.6, 1.5}, {5.6, 2.4}, {5, 2.4}, {5, 4}, {0, 4}}}};
  const FoundStructure found = found_in(b, {{1.5, 1.5}, {3.5, 2}});
  ASSERT_EQ(found.rooms.size(), 1u);
  EXPECT_TRUE(found.doors.empty());
  EXPECT_GT(test::overlap(found.rooms[0].polygon, b.rooms[0].polygon), 0.93);
}

TEST(Structure, ThreeRoomsAndACorridor) {
  const TestBuilding b = test::three_rooms_and_corridor();
  const TestWalk walk = test::walk_three_rooms(b);
  const FoundStructure found = test::recognise(walk);
  ASSERT_EQ(found.rooms.size(), 4u);
  for (const test::TestRoom& room : b.rooms) EXPECT_GT(test::best_overlap(found, room), 0.93);
  EXPECT_EQ(test::room_at(found, {6, 1})->kind, RoomKind::corridor);
  EXPECT_EQ(test::room_at(found, {2, 4})->kind, RoomKind::room);
  ASSERT_EQ(found.doors.size(), b.doors.size());
  for (const test::TestDoor& door : b.doors)
    EXPECT_TRUE(std::any_of(found.doors.begin(), found.doors.end(), [&](const FoundDoor& f) {
      return (f.position.head<2>() - door.center).norm() < 0.1;
    }));
  ASSERT_EQ(found.floors.size(), 1u);
  EXPECT_EQ(found.floors[0].rooms.size(), 4u);
  EXPECT_EQ(found.floors[0].extent.size(), 4u);
}

TEST(Structure, TwoStoreysAreTwoFloors) {
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 5, 4)}, {test::rectangle(0, 0, 4, 4), 2.9}};
  TestWalk walk(b, 7);
  walk.walk({{1.5, 1.5}, {3.5, 2.5}});
  walk.walk({{1.5, 1.5}, {3, 2.5}}, 2.9);
  const FoundStructure found = test::recognise(walk);
  ASSERT_EQ(found.rooms.size(), 2u);
  for (const test::TestRoom& room : b.rooms) EXPECT_GT(test::best_overlap(found, room), 0.97);
  ASSERT_EQ(found.floors.size(), 2u);
  EXPECT_NEAR(found.floors[0].ground_m, 0, 0.03);
  EXPECT_NEAR(found.floors[1].ground_m, 2.9, 0.03);
  ASSERT_TRUE(found.rooms[0].height_m);  // not the upper storey's ceiling
  EXPECT_NEAR(*found.rooms[0].height_m, 2.6, 0.05);
}

TEST(Structure, OneWallPlaneBoundsEveryRoomAlongIt) {
  const TestBuilding b = test::three_rooms_and_corridor();
  const TestWalk walk = test::walk_three_rooms(b);
  SceneFaces faces = walk.faces();
  // The rooms' far walls, coplanar and looking the same way, are one plane.
  SceneFace* kept = nullptr;
  std::vector<SceneFace> walls;
  walls.reserve(faces.walls.size());
  for (SceneFace& wall : faces.walls) {
    const bool far_wall = wall.plane.normal.y() < -0.9 && wall.plane.anchor.y() > 5;
    if (far_wall && kept) {
      kept->points.insert(kept->points.end(), wall.points.begin(), wall.points.end());
      continue;
    }
    walls.push_back(wall);
    if (far_wall) kept = &walls.back();
  }
  ASSERT_TRUE(kept);
  faces.walls = walls;
  const FoundStructure found = recognise_structure(walk.free_space(), faces, {}, {});
  ASSERT_EQ(found.rooms.size(), 4u);
  int bounded = 0;
  for (const FoundRoom& room : found.rooms)
    bounded += std::count(room.walls.begin(), room.walls.end(), kept->id) > 0;
  EXPECT_EQ(bounded, 3);
}

TEST(Structure, ARoomOnlyHalfSeenSaysSo) {
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 12, 8)}};
  TestWalk walk(b, 8);
  for (double heading = -3.0; heading < -1.5; heading += 0.2)
    walk.look({3, 3}, 0, heading);  // into one corner
  const FoundStructure found = test::recognise(walk);
  ASSERT_EQ(found.rooms.size(), 1u);
  EXPECT_TRUE(found.rooms[0].partial);
  EXPECT_LT(found.rooms[0].closed_share, 0.7);
}

TEST(Structure, AMissingWallIsReplacedByTheEndOfFreeSpace) {
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 5, 4)}};
  TestWalk walk(b, 9);
  walk.walk({{1.5, 1.5}, {3.5, 2.5}});
  SceneFaces faces = walk.faces();
  faces.walls.erase(faces.walls.begin() + 1);
  const FoundStructure found = recognise_structure(walk.free_space(), faces, {}, {});
  ASSERT_EQ(found.rooms.size(), 1u);
  EXPECT_GT(test::overlap(found.rooms[0].polygon, b.rooms[0].polygon), 0.93);
  EXPECT_EQ(found.rooms[0].walls.size(), 3u);
}

TEST(Structure, NothingIsFoundWithoutGroundOrWalls) {
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 5, 4)}};
  TestWalk walk(b, 10);
  walk.walk({{1.5, 1.5}});
  SceneFaces faces = walk.faces(), no_ground = faces, one_wall = faces;
  no_ground.grounds.clear();
  one_wall.walls.resize(1);
  EXPECT_TRUE(recognise_structure(walk.free_space(), no_ground, {}, {}).rooms.empty());
  EXPECT_TRUE(recognise_structure(walk.free_space(), one_wall, {}, {}).rooms.empty());
  EXPECT_TRUE(recognise_structure(FreeSpace({}), faces, {}, {}).rooms.empty());
  EXPECT_TRUE(recognise_structure(FreeSpace({}), {}, {}, {}).places.empty());
}

TEST(Structure, ATableTopTakenForGroundMakesNoStorey) {
  TestBuilding b;
  b.rooms = {{test::rectangle(0, 0, 5, 4)}};
  b.boxes = {{{2.5, 2}, {0.9, 0.6}, 0, 0.75}};
  TestWalk walk(b, 11);
  walk.walk({{1, 1}, {4, 1}});
  SceneFaces faces = walk.faces();
  SceneFace table{PlaneId{77, 0}, {Eigen::Vector3d::UnitZ(), {2.5, 2, 0.75}, 0}, {}};
  for (float x = 1.65f; x < 3.4f; x += 0.1f)
    for (float y = 1.45f; y < 2.6f; y += 0.1f) table.points.emplace_back(x, y, 0.75f);
  faces.grounds.push_back(table);
  const FoundStructure found = recognise_structure(walk.free_space(), faces, {}, {});
  ASSERT_EQ(found.rooms.size(), 1u);
  EXPECT_EQ(found.rooms[0].ground, faces.grounds[0].id);
  EXPECT_EQ(found.floors.size(), 1u);
}

TEST(Structure, RoomsKeepTheirNumbers) {
  const TestBuilding b = test::three_rooms_and_corridor();
  const TestWalk walk = test::walk_three_rooms(b);
  FoundStructure before = test::recognise(walk);
  ASSERT_EQ(before.rooms.size(), 4u);
  EXPECT_EQ(before.next_number, 4u);
  // As after a loop closure: everything is elsewhere, the walls have the same ids; and the walk goes on.
  const Se3 correction = Se3::exp((Vector6d() << 0.4, -0.3, 0.05, 0, 0, 0.05).finished());
  FreeSpace moved({});
  for (std::size_t i = 0; i < walk.poses().size(); ++i)
    moved.integrate(walk.poses()[i].keyframe, walk.depths()[i],
                    correction * walk.poses()[i].level_from_camera);
  SceneFaces faces = walk.faces();
  for (auto* list : {&faces.walls, &faces.grounds, &faces.ceilings})
    for (SceneFace& face : *list) {
      face.plane = face.plane.transformed(correction);
      for (Eigen::Vector3f& p : face.points) p = (correction * p.cast<double>().eval()).cast<float>();
    }
  std::reverse(before.rooms.begin(), before.rooms.end());  // numbers do not hang on the order
  const FoundStructure after = recognise_structure(moved, faces, before, {});
  ASSERT_EQ(after.rooms.size(), 4u);
  EXPECT_EQ(after.next_number, 4u);
  for (const FoundRoom& room : before.rooms) {
    const Eigen::Vector2d there = (correction * room.centroid).head<2>();
    const FoundRoom* same = test::room_at(after, there);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->number, room.number);
  }
}

TEST(Structure, SameInputSameOutput) {
  const TestBuilding b = test::three_rooms_and_corridor();
  const TestWalk walk = test::walk_three_rooms(b);
  const FoundStructure one = test::recognise(walk), two = test::recognise(walk);
  ASSERT_EQ(one.rooms.size(), two.rooms.size());
  for (std::size_t i = 0; i < one.rooms.size(); ++i) {
    EXPECT_EQ(one.rooms[i].polygon, two.rooms[i].polygon);
    EXPECT_EQ(one.rooms[i].walls, two.rooms[i].walls);
  }
  ASSERT_EQ(one.places.size(), two.places.size());
  for (std::size_t i = 0; i < one.places.size(); ++i) {
    EXPECT_EQ(one.places[i].position, two.places[i].position);
    EXPECT_EQ(one.places[i].neighbours, two.places[i].neighbours);
  }
}

}  // namespace
}  // namespace vsgraphs
