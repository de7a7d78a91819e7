#include "core/scene/rooms/arrangement.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

PlanLine line_through(const Eigen::Vector2d& p, double angle) {
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  return {normal, -normal.dot(p)};
}

Polygon2 polygon_of(const std::vector<OutlineEdge>& edges) {
  Polygon2 polygon;
  for (const OutlineEdge& edge : edges) polygon.push_back(edge.from);
  return polygon;
}

TEST(Arrangement, FacesCoverTheRectangleAndKnowTheirNeighbours) {
  Rng rng(3, "arrangement_test", 0);
  std::vector<PlanLine> lines;
  for (int i = 0; i < 9; ++i)
    lines.push_back(line_through({rng.uniform(-2, 2), rng.uniform(-2, 2)}, rng.uniform(0, 6)));
  const Arrangement arrangement({-3, -3}, {3, 3}, lines);
  double area = 0;
  for (int f = 0; f < static_cast<int>(arrangement.faces().size()); ++f) {
    const Arrangement::Face& face = arrangement.faces()[static_cast<std::size_t>(f)];
    area += signed_area(face.corners);
    EXPECT_EQ(arrangement.face_at(centroid(face.corners)), f);
    for (std::size_t e = 0; e < face.corners.size(); ++e) {
      const int other = arrangement.neighbour(f, static_cast<int>(e));
      const Eigen::Vector2d &a = face.corners[e], &b = face.corners[(e + 1) % face.corners.size()];
      if (face.lines[e] < 0) {
        EXPECT_EQ(other, -1);
        continue;
      }
      ASSERT_GE(other, 0);
      // Just across the edge lies the neighbour.
      const Eigen::Vector2d way = (b - a).normalized(), right(way.y(), -way.x());
      EXPECT_EQ(arrangement.face_at(0.5 * (a + b) + 1e-9 * right), other);
    }
  }
  EXPECT_NEAR(area, 36, 1e-9);
}

TEST(Arrangement, OutlineOfAConcaveSetJoinsEdgesOnOneLine) {
  const std::vector<PlanLine> lines{line_through({1, 0}, 0), line_through({0, 1}, 1.5707963267948966)};
  const Arrangement arrangement({0, 0}, {3, 2}, lines);
  ASSERT_EQ(arrangement.faces().size(), 4u);
  std::vector<char> inside(4, 1);
  inside[static_cast<std::size_t>(arrangement.face_at({2, 1.5}))] = 0;
  const std::vector<OutlineEdge> outline = arrangement.outline(inside);
  EXPECT_NEAR(signed_area(polygon_of(outline)), 4, 1e-9);  // counter-clockwise, an L
  EXPECT_TRUE(is_simple(polygon_of(outline)));
  for (std::size_t i = 0; i < outline.size(); ++i)
    EXPECT_NEAR((outline[i].to - outline[(i + 1) % outline.size()].from).norm(), 0, 1e-9);
}

TEST(Arrangement, OfTwoPiecesThatTouchAtACornerTheLargerIsOutlined) {
  const std::vector<PlanLine> lines{line_through({1, 0}, 0), line_through({0, 1}, 1.5707963267948966)};
  const Arrangement arrangement({0, 0}, {3, 2}, lines);
  std::vector<char> inside(4, 0);
  inside[static_cast<std::size_t>(arrangement.face_at({0.5, 0.5}))] = 1;
  inside[static_cast<std::size_t>(arrangement.face_at({2, 1.5}))] = 1;
  EXPECT_NEAR(signed_area(polygon_of(arrangement.outline(inside))), 2, 1e-9);
  EXPECT_TRUE(arrangement.outline({0, 0, 0, 0}).empty());
}

}  // namespace
}  // namespace vsgraphs
