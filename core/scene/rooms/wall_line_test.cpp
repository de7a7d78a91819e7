#include "core/scene/rooms/wall_line.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

// The wall y = 2, looking towards -y, seen from x = 1 to 5 except for a doorway from 3 to 3.9, above which it goes on.
SceneFace wall_with_door() {
  SceneFace face{PlaneId{4, 0}, {-Eigen::Vector3d::UnitY(), {3, 2, 1}, 0}, {}};
  for (int i = 0; i <= 40; ++i)
    for (int k = 0; k <= 25; ++k) {
      const float x = 1 + 0.1f * static_cast<float>(i), z = 0.1f * static_cast<float>(k);
      if (x < 3 || x > 3.9f || z > 2.05f) face.points.emplace_back(x, 2, z);
    }
  return face;
}

TEST(WallLine, KnowsItsSideAndWhatWasSeen) {
  const auto wall = WallLine::from_face(wall_with_door(), 0, {});
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->distance({3, 1.2}), 0.8, 1e-9);
  EXPECT_GT(wall->distance({3, 0}), 0);  // the room
  const Eigen::Vector2d along = wall->along();
  EXPECT_GT(along.x() * wall->normal().y() - along.y() * wall->normal().x(), 0);  // the room to the left
  EXPECT_NEAR((wall->point(wall->coordinate({1.7, 2})) - Eigen::Vector2d(1.7, 2)).norm(), 0, 1e-9);
  EXPECT_NEAR(wall->to_m() - wall->from_m(), 4, 1e-4);
  EXPECT_NEAR(wall->middle().x(), 3, 1e-4);
  const auto seen = [&](double a, double b, bool in_band) {
    const double s = wall->coordinate({a, 2}), t = wall->coordinate({b, 2});
    return wall->seen_m(std::min(s, t), std::max(s, t), in_band);
  };
  EXPECT_NEAR(seen(1.5, 2.5, true), 1, 0.02);
  EXPECT_NEAR(seen(3.2, 3.7, true), 0, 0.02);
  EXPECT_NEAR(seen(3.2, 3.7, false), 0.5, 0.02);  // the lintel
  EXPECT_NEAR(seen(-3, 0.5, false), 0, 0.02);
}

TEST(WallLine, OnlyVerticalFacesWithPointsOnTheStorey) {
  SceneFace face = wall_with_door();
  EXPECT_FALSE(WallLine::from_face(face, 5, {}));
  EXPECT_FALSE(WallLine::from_face(face, -5, {}));
  face.plane.normal = Eigen::Vector3d(0, -1, 0.8).normalized();
  EXPECT_FALSE(WallLine::from_face(face, 0, {}));
  EXPECT_EQ(wall_lines(std::vector{wall_with_door(), face}, 0, {}).size(), 1u);
}

}  // namespace
}  // namespace vsgraphs
