// Where a lost camera looks first.
#include "core/tracking/recovery.h"

#include <gtest/gtest.h>

#include "core/loops/loop_closer.h"
#include "core/loops/test_loop_world.h"
#include "core/vision/place_keeper.h"

namespace vsgraphs {
namespace {

using namespace test;

// Two rooms that look the same, 9 m apart: keyframes 30 and later stand in the second.
class TwoRooms : public ::testing::Test {
 protected:
  static LoopWorldOptions options() {
    LoopWorldOptions o;
    o.keyframes = 36;
    o.second_room_at = {9, 0, 0};
    return o;
  }
  static FoundRoom room_at_x(RoomNumber number, double x) {
    FoundRoom room;
    room.number = number;
    room.polygon = {{x - 3, -3}, {x + 3, -3}, {x + 3, 3}, {x - 3, 3}};
    room.ground_m = -1.5;
    return room;
  }
  TwoRooms() {
    auto structure = std::make_shared<FoundStructure>();
    structure->rooms = {room_at_x(4, 0), room_at_x(7, 9)};
    Eigen::Matrix3d level;
    level << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // the world's y points down
    structure->level_from_world = {level, Eigen::Vector3d::Zero()};
    world_.map.apply(SetStructure{structure});
    complete(world_.map, places_);
  }
  std::vector<KeyframeId> likely(int like, RoomNumber last_room) {
    const Map& map = world_.map;
    return recovery_.likely_places(
        {world_.map.snapshot(), std::make_shared<const PlaceIndex>(places_)},
        *map.keyframes().find(world_.ids[static_cast<std::size_t>(like)])->features, last_room);
  }
  static bool second(KeyframeId id) { return id.index >= 30; }

  LoopWorld world_{options()};
  PlaceIndex places_;
  Recovery recovery_{RecoveryOptions{}, world_.camera, world_.pyramid, 1};
};

TEST_F(TwoRooms, APointIsInTheRoomAroundIt) {
  EXPECT_EQ(world_.map.room_at({1, 0.5, -1}), 4U);
  EXPECT_EQ(world_.map.room_at({8, 0.5, 2}), 7U);
  EXPECT_EQ(world_.map.room_at({4.5, 0, 0}), no_room) << "between the rooms";
  EXPECT_EQ(world_.map.room_at({1, -4, -1}), no_room) << "a storey above";
}

TEST_F(TwoRooms, TheLastKnownRoomComesFirstAndTheOtherIsNotForgotten) {
  for (const RoomNumber last : {4U, 7U}) {
    const auto found = likely(32, last);
    ASSERT_EQ(found.size(), 5U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(second(found[i]), last == 7U) << i;
    EXPECT_TRUE(
        std::any_of(found.begin(), found.end(), [&](KeyframeId id) { return second(id) != (last == 7U); }));
  }
}

TEST_F(TwoRooms, WithoutARoomTheLookAloneDecides) {
  const auto found = likely(5, no_room);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front(), world_.ids[5]);
}

}  // namespace
}  // namespace vsgraphs
