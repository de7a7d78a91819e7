#include "core/geometry/polygon.h"

#include <gtest/gtest.h>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

const Polygon2 kEll{{0, 0}, {6, 0}, {6, 3}, {2, 3}, {2, 5}, {0, 5}};

TEST(Polygon, AreaAndCentroidOfAnEll) {
  EXPECT_DOUBLE_EQ(signed_area(kEll), 22.0);
  // Two rectangles: 6 x 3 around (3, 1.5) and 2 x 2 around (1, 4).
  const Eigen::Vector2d expected = (18.0 * Eigen::Vector2d(3, 1.5) + 4.0 * Eigen::Vector2d(1, 4)) / 22.0;
  EXPECT_TRUE(centroid(kEll).isApprox(expected, 1e-14));
  const Polygon2 reversed(kEll.rbegin(), kEll.rend());
  EXPECT_DOUBLE_EQ(signed_area(reversed), -22.0);
  EXPECT_TRUE(centroid(reversed).isApprox(expected, 1e-14));
}

TEST(Polygon, CentroidKeepsItsDigitsFarFromTheOrigin) {
  Polygon2 far = kEll;
  for (auto& p : far) p += Eigen::Vector2d(1e7, -1e7);
  EXPECT_LT((centroid(far) - Eigen::Vector2d(1e7, -1e7) - centroid(kEll)).norm(), 1e-8);
}

TEST(Polygon, SimpleMeansNoTouchingEdges) {
  EXPECT_TRUE(is_simple(kEll));
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}}));
  EXPECT_FALSE(is_simple({{0, 0}, {2, 2}, {2, 0}, {0, 2}}));                 // bow tie
  EXPECT_FALSE(is_simple({{0, 0}, {0, 0}, {1, 0}, {1, 1}}));                 // repeated vertex
  EXPECT_FALSE(is_simple({{0, 0}, {4, 0}, {2, 0}, {2, 3}}));                 // spike along an edge
  EXPECT_FALSE(is_simple({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}));         // vertex on another edge
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 1 - 1e-9}}));  // edge of no length
}

TEST(Polygon, ContainsAndDistanceAgreeWithTheRectanglesOfAnEll) {
  Rng rng(1, "polygon_test", 0);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(rng.uniform(-1, 7), rng.uniform(-1, 6));
    const bool lower = p.x() > 0 && p.x() < 6 && p.y() > 0 && p.y() < 3;
    const bool upper = p.x() > 0 && p.x() < 2 && p.y() > 0 && p.y() < 5;
    EXPECT_EQ(contains(kEll, p), lower || upper) << p.transpose();
  }
  EXPECT_DOUBLE_EQ(distance_to_boundary(kEll, {3, 1}), 1.0);
  EXPECT_DOUBLE_EQ(distance_to_boundary(kEll, {9, 7}), 5.0);  // outside, to the corner (6, 3)
  EXPECT_DOUBLE_EQ(distance_to_segment({1, 1}, {2, 0}, {2, 0}), std::sqrt(2.0));
}

}  // namespace
}  // namespace vsgraphs
