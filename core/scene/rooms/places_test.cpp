#include "core/scene/rooms/places.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/scene/rooms/test_buildings.h"

namespace vsgraphs {
namespace {

TEST(Places, LieInTheirRoomsKeepTheirDistanceAndReachEachOther) {
  const test::TestBuilding b = test::three_rooms_and_corridor();
  const FoundStructure found = test::recognise(test::walk_three_rooms(b));
  ASSERT_EQ(found.rooms.size(), 4u);
  std::size_t in_doorways = 0, edges = 0;
  for (std::size_t i = 0; i < found.places.size(); ++i) {
    const Place& place = found.places[i];
    edges += place.neighbours.size();
    EXPECT_TRUE(std::is_sorted(place.neighbours.begin(), place.neighbours.end()));
    for (const std::uint32_t n : place.neighbours) {
      const Place& other = found.places[n];
      EXPECT_TRUE(std::count(other.neighbours.begin(), other.neighbours.end(), i));
      EXPECT_TRUE(place.room == other.room || place.room == no_room || other.room == no_room);
    }
    if (place.room == no_room) {
      ++in_doorways;
      continue;
    }
    const FoundRoom* room = test::room_at(found, place.position.head<2>());
    ASSERT_TRUE(room);
    EXPECT_EQ(room->number, place.room);
    EXPECT_GE(place.clearance_m, PlaceOptions{}.min_clearance_m);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((place.position - found.places[j].position).norm(), PlaceOptions{}.spacing_m);
  }
  EXPECT_EQ(in_doorways, b.doors.size());
  EXPECT_LT(edges, 4 * found.places.size());  // sparse
  // From the first place one comes to all others.
  std::vector<std::uint32_t> reached{0};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const std::uint32_t n : found.places[reached[i]].neighbours)
      if (!std::count(reached.begin(), reached.end(), n)) reached.push_back(n);
  EXPECT_EQ(reached.size(), found.places.size());
}

}  // namespace
}  // namespace vsgraphs
