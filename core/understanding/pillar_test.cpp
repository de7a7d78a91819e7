#include "core/understanding/pillar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/understanding/test_seen_planes.h"

namespace vsgraphs {
namespace {

const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                      z = Eigen::Vector3d::UnitZ();

class Pillar : public ::testing::Test {
 protected:
  void called(PlaneId id, const char* name, float votes) {
    seen_.map.apply(SetPlaneClasses{id, {{class_id(name), votes}}});
  }
  test::SeenPlanes seen_;
};

TEST_F(Pillar, IsMadeOfItsFaces) {
  called(seen_.see(SurfaceRole::other, {2, 0, 1.3}, 0.2 * x, 1.2 * z), "pillar", 3);
  called(seen_.see(SurfaceRole::other, {2.2, 0.2, 1.3}, 0.2 * y, 1.2 * z), "column", 3);
  const auto found = seen_.find(pillar_kind());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].size_m.x(), 0.4, 0.15);
  EXPECT_NEAR(found[0].size_m.y(), 0.4, 0.15);
  EXPECT_NEAR(found[0].size_m.z(), 2.4, 0.2);
  EXPECT_EQ(found[0].planes.size(), 2U);
}

TEST_F(Pillar, TakesMoreThanOneLookAndTheRightShape) {
  called(seen_.see(SurfaceRole::other, {2, 0, 1.3}, 0.2 * x, 1.2 * z), "pillar", 1);
  called(seen_.see(SurfaceRole::other, {4, 0, 1.3}, 0.2 * x, 1.2 * z), "cabinet", 9);
  called(seen_.see(SurfaceRole::wall, {8, 0, 1.3}, 2 * x, 1.2 * z), "pillar", 9);
  called(seen_.see(SurfaceRole::other, {12, 0, 0.3}, 0.2 * x, 0.2 * z), "pillar", 9);
  EXPECT_TRUE(seen_.find(pillar_kind()).empty());
}

}  // namespace
}  // namespace vsgraphs
