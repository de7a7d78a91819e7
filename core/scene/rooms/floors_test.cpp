#include "core/scene/rooms/floors.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

FoundRoom room(RoomNumber number, double ground_m, std::uint32_t ground, const Eigen::Vector3d& centroid) {
  FoundRoom r;
  r.number = number;
  r.ground_m = ground_m;
  r.ground = {ground, 0};
  r.centroid = centroid;
  r.polygon = {{0, 0}, {1, 0}, {1, 1}};
  return r;
}

TEST(Floors, RoomsOfOneHeightShareAFloor) {
  const std::vector<FoundRoom> rooms{room(3, 2.85, 7, {1, 1, 2.85}), room(0, 0.0, 5, {0, 0, 0}),
                                     room(2, 0.1, 5, {4, 2, 0.1}), room(1, 0.2, 6, {2, 4, 0.2})};
  const std::vector<FoundFloor> floors = find_floors(rooms, {});
  ASSERT_EQ(floors.size(), 2u);
  EXPECT_EQ(floors[0].rooms, (std::vector<RoomNumber>{0, 1, 2}));
  EXPECT_EQ(floors[0].grounds, (std::vector<PlaneId>{{5, 0}, {6, 0}}));
  EXPECT_NEAR((floors[0].centroid - Eigen::Vector3d(2, 2, 0.1)).norm(), 0, 1e-9);
  EXPECT_NEAR(floors[0].ground_m, 0.1, 1e-9);
  EXPECT_EQ(floors[0].extent.size(), 3u);
  EXPECT_EQ(floors[1].rooms, std::vector<RoomNumber>{3});
}

TEST(Floors, SmallStepsDoNotChainStoreysTogether) {
  std::vector<FoundRoom> rooms;
  for (RoomNumber i = 0; i < 8; ++i) rooms.push_back(room(i, 0.2 * i, i, {0, 0, 0.2 * i}));
  EXPECT_EQ(find_floors(rooms, {}).size(), 4u);  // two by two, within 0.3 m
  EXPECT_TRUE(find_floors({}, {}).empty());
}

}  // namespace
}  // namespace vsgraphs
