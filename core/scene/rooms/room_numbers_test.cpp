#include "core/scene/rooms/room_numbers.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace vsgraphs {
namespace {

FoundRoom room(double x0, double x1, std::initializer_list<std::uint32_t> walls, RoomNumber number = no_room,
               double ground_m = 0) {
  FoundRoom r;
  r.polygon = {{x0, 0}, {x1, 0}, {x1, 4}, {x0, 4}};
  r.area_m2 = 4 * (x1 - x0);
  r.ground_m = ground_m;
  r.number = number;
  for (const std::uint32_t wall : walls) r.walls.push_back({wall, 0});
  return r;
}

std::vector<RoomNumber> numbers_of(std::vector<FoundRoom> previous, std::vector<FoundRoom> rooms,
                                   RoomNumber& next) {
  number_rooms(previous, rooms, next);
  std::vector<RoomNumber> numbers;
  for (const FoundRoom& r : rooms) numbers.push_back(r.number);
  return numbers;
}

TEST(RoomNumbers, FollowAreaOrWalls) {
  RoomNumber next = 9;
  // The first grew, the second moved away with its walls, the third is new.
  EXPECT_EQ(numbers_of({room(0, 3, {1, 2, 3}, 4), room(10, 13, {5, 6, 7}, 2)},
                       {room(20, 23, {5, 6, 7}), room(0, 6, {11, 12}), room(30, 33, {8, 9})}, next),
            (std::vector<RoomNumber>{2, 4, 9}));
  EXPECT_EQ(next, 10u);
}

TEST(RoomNumbers, ANumberIsGivenOnce) {
  RoomNumber next = 3;
  // One room turns out to be two: the larger share keeps the number.
  EXPECT_EQ(numbers_of({room(0, 8, {1, 2, 3, 4}, 0)}, {room(0, 3, {1, 9}), room(3, 8, {2, 3, 4})}, next),
            (std::vector<RoomNumber>{3, 0}));
  // Two turn out to be one.
  next = 3;
  EXPECT_EQ(numbers_of({room(0, 3, {1, 2}, 0), room(3, 8, {3, 4, 5}, 1)}, {room(0, 8, {1, 3, 4, 5})}, next),
            (std::vector<RoomNumber>{1}));
  EXPECT_EQ(next, 3u);
}

TEST(RoomNumbers, OneStoreyDoesNotInheritFromAnother) {
  RoomNumber next = 1;
  EXPECT_EQ(numbers_of({room(0, 3, {1, 2}, 0, 0.0)}, {room(0, 3, {1, 2}, no_room, 2.8)}, next),
            (std::vector<RoomNumber>{1}));
}

}  // namespace
}  // namespace vsgraphs
