// Simple polygons in the plane (metres): rooms seen from above. Vertices run counter-clockwise; the closing edge from
// the last vertex to the first is implied. Every function is O(vertices) unless it says otherwise.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace vsgraphs {

using Polygon2 = std::vector<Eigen::Vector2d>;

// Positive for counter-clockwise polygons, m^2.
double signed_area(const Polygon2& polygon);

// Centre of mass of the enclosed area; the polygon's area must not be zero.
Eigen::Vector2d centroid(const Polygon2& polygon);

// At least three vertices, no edge shorter than `min_edge_m`, no two edges that touch except neighbours at their
// shared vertex, and no neighbours folded back onto each other. O(vertices^2).
bool is_simple(const Polygon2& polygon, double min_edge_m = 1e-6);

// Inside by the even-odd rule; points exactly on the boundary may fall on either side.
bool contains(const Polygon2& polygon, const Eigen::Vector2d& point);

double distance_to_segment(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

// Distance to the nearest edge, whether the point lies inside or outside.
double distance_to_boundary(const Polygon2& polygon, const Eigen::Vector2d& point);

}  // namespace vsgraphs
