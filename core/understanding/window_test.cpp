#include "core/understanding/window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/understanding/test_seen_planes.h"

namespace vsgraphs {
namespace {

using ::testing::ElementsAre;

const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();

TEST(Window, IsABoxInItsWallSeenFromItsRoom) {
  test::SeenPlanes seen;
  seen.add_room(2, {0, 0}, {4, 3});
  seen.see(SurfaceRole::window, {2, 3, 1.5}, 0.6 * x, 0.5 * z);  // faces -y, into the room
  const auto found = seen.find(window_kind());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].size_m.x(), 1.2, 0.15);
  EXPECT_NEAR(found[0].size_m.z(), 1.0, 0.15);
  EXPECT_LT(found[0].size_m.y(), 0.02);
  EXPECT_NEAR(std::abs(found[0].along.x()), 1, 1e-6);
  EXPECT_LT((found[0].centre - Eigen::Vector3d(2, 3, 1.5)).norm(), 0.1);
  EXPECT_THAT(found[0].rooms, ElementsAre(2));
}

TEST(Window, SashesAreOneAndNeighboursTwo) {
  test::SeenPlanes seen;
  seen.see(SurfaceRole::window, {1, 3, 1.5}, 0.3 * x, 0.5 * z);
  seen.see(SurfaceRole::window, {1.65, 3.03, 1.5}, 0.3 * x, 0.5 * z);
  seen.see(SurfaceRole::window, {3, 3, 1.5}, 0.3 * x, 0.5 * z);
  seen.see(SurfaceRole::window, {5, 3, 1.5}, 0.05 * x, 0.5 * z);
  seen.see(SurfaceRole::wall, {7, 3, 1.5}, 0.5 * x, 0.5 * z);
  EXPECT_EQ(seen.find(window_kind()).size(), 2U);
}

}  // namespace
}  // namespace vsgraphs
