// The faces into which straight lines divide a rectangle, and the outline of a chosen set of them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "core/geometry/polygon.h"

namespace vsgraphs {

// normal . p + offset_m = 0, |normal| = 1.
struct PlanLine {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset_m = 0;

  double distance(const Eigen::Vector2d& p) const { return normal.dot(p) + offset_m; }
  Eigen::Vector2d along() const { return {normal.y(), -normal.x()}; }
};

// A piece of an outline on one of the lines (-1: on the rectangle), walked with the inside to the left.
struct OutlineEdge {
  Eigen::Vector2d from, to;
  int line = -1;
};

class Arrangement {
 public:
  static constexpr int max_lines = 30;
  struct Face {
    Polygon2 corners;         // convex, counter-clockwise
    std::vector<int> lines;   // of the edge from each corner to the next; -1: the rectangle
    std::uint32_t sides = 0;  // bit i: the face lies on the positive side of line i
  };

  // Throws InvariantError for more than max_lines lines. O(lines^3).
  Arrangement(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const std::vector<PlanLine>& lines);

  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<PlanLine>& lines() const { return lines_; }
  // The face that holds a point of the rectangle; -1 for points within rounding of a line's crossing.
  int face_at(const Eigen::Vector2d& point) const;
  // The face on the other side of a face's edge, -1 beyond the rectangle.
  int neighbour(int face, int edge) const;
  // Outline of the largest connected piece of the faces with a non-zero flag: counter-clockwise, holes left out,
  // consecutive edges on one line joined.
  std::vector<OutlineEdge> outline(const std::vector<char>& inside) const;

 private:
  void split_by(int line);

  std::vector<PlanLine> lines_;
  std::vector<Face> faces_;
  std::map<std::uint32_t, int> face_by_sides_;
};

}  // namespace vsgraphs
