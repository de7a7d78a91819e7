#include "core/scene/rooms/room_outline.h"

#include <algorithm>
#include <cmath>

#include "core/scene/rooms/min_cut.h"

namespace vsgraphs {
namespace {

constexpr double step_m = 0.1;           // at which walls and edges are looked at
constexpr double seen_edge_cost = 0.02;  // per metre; not 0: of two outlines along walls the shorter one
constexpr double margin_m = 1.0;

// Everything the prices depend on.
class OutlineProblem {
 public:
  OutlineProblem(int cluster, const LevelMap& map, const Clusters& clusters, std::span<const WallLine> walls,
                 std::span<const std::size_t> nearby, const OutlineOptions& options)
      : cluster_(cluster),
        map_(map),
        clusters_(clusters),
        walls_(walls),
        nearby_(nearby),
        options_(options) {}

  RoomOutline solve() {
    const std::vector<Eigen::Vector2d> cells = cells_of(cluster_, map_, clusters_);
    low_ = high_ = cells.front();
    for (const Eigen::Vector2d& p : cells) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    const std::vector<PlanLine> lines = outline_lines(cluster_, map_, clusters_, walls_, nearby_, options_);
    const Arrangement arrangement(low_ - Eigen::Vector2d::Constant(margin_m),
                                  high_ + Eigen::Vector2d::Constant(margin_m), lines);
    RoomOutline outline;
    outline.edges = arrangement.outline(choose_faces(arrangement));
    measure(outline);
    return outline;
  }

 private:
  int label(int index) const { return index < 0 ? -1 : clusters_.labels[static_cast<std::size_t>(index)]; }

  std::vector<char> choose_faces(const Arrangement& arrangement) const {
    const auto& faces = arrangement.faces();
    std::vector<double> own(faces.size(), 0), others(faces.size(), 0);
    for (int i = 0; i < map_.frame.size(); ++i) {
      if (label(i) < 0) continue;
      const Eigen::Vector2d center = map_.frame.center(i);
      if ((center.array() < low_.array() - margin_m).any() ||
          (center.array() > high_.array() + margin_m).any())
        continue;
      const int face = arrangement.face_at(center);
      if (face >= 0)
        (label(i) == cluster_ ? own : others)[static_cast<std::size_t>(face)] += map_.frame.cell_area_m2();
    }
    MinCut cut(static_cast<int>(faces.size()));
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
      const auto i = static_cast<std::size_t>(f);
      const double unknown = std::max(0.0, signed_area(faces[i].corners) - own[i] - others[i]);
      cut.add_node_cost(f, others[i] + options_.unknown_cost * unknown, own[i]);
      add_edge_costs(arrangement, f, cut);
    }
    return cut.solve();
  }

  void add_edge_costs(const Arrangement& arrangement, int f, MinCut& cut) const {
    const Arrangement::Face& face = arrangement.faces()[static_cast<std::size_t>(f)];
    for (std::size_t e = 0; e < face.corners.size(); ++e) {
      const int other = arrangement.neighbour(f, static_cast<int>(e));
      const Eigen::Vector2d &a = face.corners[e], &b = face.corners[(e + 1) % face.corners.size()];
      if (other < 0)
        cut.add_node_cost(f, edge_cost(a, b), 0);  // nothing is inside beyond the rectangle
      else if (other > f)                          // each pair once
        cut.add_edge_cost(f, other, edge_cost(a, b), edge_cost(b, a));
    }
  }

  // Of an outline that runs from a to b with the room on its left.
  double edge_cost(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    const double length = (b - a).norm();
    const int pieces = std::max(1, static_cast<int>(std::lround(length / step_m)));
    double cost = 0;
    for (int i = 0; i < pieces; ++i) {
      const Eigen::Vector2d from = a + (b - a) * i / pieces, to = a + (b - a) * (i + 1) / pieces;
      cost += closed(from, to) ? seen_edge_cost : options_.unseen_edge_cost;
    }
    return cost * length / pieces;
  }

  bool closed(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    return std::any_of(nearby_.begin(), nearby_.end(),
                       [&](std::size_t w) { return wall_covers(walls_[w], a, b); }) ||
           opening_covers(0.5 * (a + b));
  }

  bool wall_covers(const WallLine& wall, const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    if (wall.along().dot(b - a) < 0.95 * (b - a).norm()) return false;
    if (std::abs(wall.distance(0.5 * (a + b))) > options_.same_line_m + 0.03) return false;
    const double from = wall.coordinate(a), to = wall.coordinate(b);
    return wall.seen_m(from, to, false) > 0.5 * (to - from);
  }

  bool opening_covers(const Eigen::Vector2d& p) const {
    return std::any_of(clusters_.openings.begin(), clusters_.openings.end(), [&](const ClusterOpening& o) {
      const Eigen::Vector2d to = p - o.opening.center;
      return std::abs(to.dot(o.opening.along())) <= 0.5 * o.opening.width_m + 0.1 &&
             std::abs(to.dot(o.opening.normal)) <= 0.5 * o.opening.thickness_m + 0.3;
    });
  }

  // Is something solid between a piece of the outline and the room's free space?
  bool solid(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    const Eigen::Vector2d way = (b - a).normalized(), inward(-way.y(), way.x());
    for (double d = -1.5 * map_.frame.cell_m; d <= options_.proximity_m; d += 0.5 * map_.frame.cell_m) {
      const int index = map_.frame.index_at(0.5 * (a + b) + d * inward);
      if (index < 0) continue;
      if (map_.cells[static_cast<std::size_t>(index)] == CellState::blocked) return true;
      if (label(index) == cluster_ && d > 1.5 * map_.frame.cell_m) return false;
    }
    return false;
  }

  void measure(RoomOutline& outline) const {
    std::vector<double> bounding(walls_.size(), 0);
    for (const OutlineEdge& edge : outline.edges) {
      const double length = (edge.to - edge.from).norm();
      const int pieces = std::max(1, static_cast<int>(std::lround(length / step_m)));
      outline.perimeter_m += length;
      for (int i = 0; i < pieces; ++i) {
        const Eigen::Vector2d a = edge.from + (edge.to - edge.from) * i / pieces,
                              b = edge.from + (edge.to - edge.from) * (i + 1) / pieces;
        const bool seen = closed(a, b);
        if (seen) outline.closed_m += length / pieces;
        if (seen || solid(a, b)) outline.solid_m += length / pieces;
        for (const std::size_t w : nearby_)
          if (wall_covers(walls_[w], a, b)) bounding[w] += length / pieces;
      }
    }
    for (std::size_t w = 0; w < bounding.size(); ++w)
      if (bounding[w] >= options_.min_wall_m) outline.walls.push_back(w);
  }

  int cluster_;
  const LevelMap& map_;
  const Clusters& clusters_;
  std::span<const WallLine> walls_;
  std::span<const std::size_t> nearby_;
  const OutlineOptions& options_;
  Eigen::Vector2d low_, high_;
};

}  // namespace

Polygon2 RoomOutline::polygon() const {
  Polygon2 polygon;
  for (const OutlineEdge& edge : edges) polygon.push_back(edge.from);
  return polygon;
}

RoomOutline outline_room(int cluster, const LevelMap& map, const Clusters& clusters,
                         std::span<const WallLine> walls, std::span<const std::size_t> nearby,
                         const OutlineOptions& options) {
  return OutlineProblem(cluster, map, clusters, walls, nearby, options).solve();
}

}  // namespace vsgraphs
