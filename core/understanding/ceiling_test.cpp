#include "core/understanding/ceiling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/understanding/test_seen_planes.h"

namespace vsgraphs {
namespace {

using ::testing::ElementsAre;

const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();

TEST(Ceiling, IsALevelBoxWithTheRoomsBelow) {
  test::SeenPlanes seen;
  seen.add_room(4, {0, 0}, {4, 3});
  seen.add_room(7, {4.2, 0}, {9, 3});
  const PlaneId wide = seen.see(SurfaceRole::ceiling, {2, 1.5, 2.6}, 1.5 * y, 2 * x);
  seen.structure.rooms[1].ceiling = wide;
  seen.see(SurfaceRole::ground, {2, 1.5, 0}, 2 * x, 1.5 * y);
  const auto found = seen.find(ceiling_kind());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, "ceiling");
  EXPECT_NEAR(found[0].centre.z(), 2.6, 0.01);
  EXPECT_NEAR(found[0].size_m.z(), 0, 0.01);
  EXPECT_NEAR(std::max(found[0].size_m.x(), found[0].size_m.y()), 4, 0.2);
  EXPECT_NEAR(std::min(found[0].size_m.x(), found[0].size_m.y()), 3, 0.2);
  EXPECT_THAT(found[0].rooms, ElementsAre(4, 7));
}

TEST(Ceiling, PiecesOfOneAreOne) {
  test::SeenPlanes seen;
  seen.see(SurfaceRole::ceiling, {1, 1, 2.6}, y, x);
  seen.see(SurfaceRole::ceiling, {3.05, 1, 2.6}, y, x);
  seen.see(SurfaceRole::ceiling, {9, 1, 2.6}, y, x);
  seen.see(SurfaceRole::ceiling, {20, 1, 2.6}, 0.2 * y, 0.2 * x);
  EXPECT_EQ(seen.find(ceiling_kind()).size(), 2U) << "the smallest is none";
}

}  // namespace
}  // namespace vsgraphs
