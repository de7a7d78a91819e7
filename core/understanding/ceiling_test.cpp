#include "core/understanding/ceiling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/understanding/test_seen_planes.h"

namespace vsgraphs {
namespace {

using ::testing::ElementsAre;

const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();

TEST(Ceiling, IsALevelBoxOverItsRoom) {
  test::SeenPlanes seen;
  seen.add_room(4, {0, 0}, {4, 3});
  seen.add_room(7, {4.1, 0}, {9, 3});
  seen.add_room(8, {9.1, 0}, {12, 3});
  const PlaneId wide = seen.see(SurfaceRole::ceiling, {4.5, 1.5, 2.6}, 1.5 * y, 4.5 * x);
  seen.structure.rooms[0].ceiling = seen.structure.rooms[1].ceiling = wide;
  const auto found = seen.find(ceiling_kind());
  ASSERT_EQ(found.size(), 2U) << "nobody saw the third room's";
  EXPECT_EQ(found[0].kind, "ceiling");
  EXPECT_TRUE(found[0].centre.isApprox(Eigen::Vector3d(2, 1.5, 2.6)));
  EXPECT_TRUE(found[0].size_m.isApprox(Eigen::Vector3d(4, 3, 0)));
  EXPECT_NEAR(std::abs(found[0].along.x()), 1, 1e-9);
  EXPECT_THAT(found[0].planes, ElementsAre(wide));
  EXPECT_THAT(found[0].rooms, ElementsAre(4));
  EXPECT_THAT(found[1].rooms, ElementsAre(7));
}

}  // namespace
}  // namespace vsgraphs
