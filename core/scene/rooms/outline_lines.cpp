#include "core/scene/rooms/outline_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vsgraphs {
namespace {

constexpr double step_m = 0.1;  // at which walls are looked at

// The cluster one meets on the way from a wall into the room, -1 if another wall or nothing comes first.
int cluster_before(const LevelMap& map, const Clusters& clusters, const WallLine& wall, double coordinate,
                   double proximity_m) {
  const double step = 0.5 * map.frame.cell_m;
  for (double d = step; d <= proximity_m; d += step) {
    const int index = map.frame.index_at(wall.point(coordinate) + d * wall.normal());
    if (index < 0) return -1;
    const int label = clusters.labels[static_cast<std::size_t>(index)];
    if (label >= 0) return label;
    if (d > 2.5 * map.frame.cell_m && map.walls[static_cast<std::size_t>(index)]) return -1;
  }
  return -1;
}

class LineCollector {
 public:
  LineCollector(int cluster, const LevelMap& map, const Clusters& clusters, std::span<const WallLine> walls,
                std::span<const std::size_t> nearby, const OutlineOptions& options)
      : cluster_(cluster),
        map_(map),
        clusters_(clusters),
        walls_(walls),
        nearby_(nearby),
        options_(options) {}

  std::vector<PlanLine> collect() {
    std::vector<PlanLine> lines = lines_of_walls();
    add_openings(lines);
    add_bounds(lines);
    return lines;
  }

 private:
  bool same_line(const PlanLine& line, const Eigen::Vector2d& normal, const Eigen::Vector2d& middle) const {
    const double cosine = std::cos(options_.same_line_deg * std::numbers::pi / 180);
    return std::abs(line.normal.dot(normal)) >= cosine &&
           std::abs(line.distance(middle)) <= options_.same_line_m;
  }

  // The longest wall on a line says where it runs.
  std::vector<PlanLine> lines_of_walls() const {
    std::vector<std::size_t> order(nearby_.begin(), nearby_.end());
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return walls_[a].seen_m() > walls_[b].seen_m(); });
    std::vector<PlanLine> lines;
    for (const std::size_t w : order) {
      const WallLine& wall = walls_[w];
      const bool known = std::any_of(lines.begin(), lines.end(), [&](const PlanLine& line) {
        return same_line(line, wall.normal(), wall.middle());
      });
      if (!known && lines.size() < Arrangement::max_lines - 8)
        lines.push_back({wall.normal(), -wall.normal().dot(wall.middle())});
    }
    return lines;
  }

  // An opening whose wall was not made out closes the room all the same.
  void add_openings(std::vector<PlanLine>& lines) const {
    for (const ClusterOpening& o : clusters_.openings) {
      if (o.clusters[0] != cluster_ && o.clusters[1] != cluster_) continue;
      const double side = o.clusters[1] == cluster_ ? 1 : -1;
      const Eigen::Vector2d threshold =
          o.opening.center + 0.5 * side * o.opening.thickness_m * o.opening.normal;
      add_unless_near(lines, o.opening.normal, threshold, 0.3);
    }
  }

  void add_unless_near(std::vector<PlanLine>& lines, const Eigen::Vector2d& normal,
                       const Eigen::Vector2d& point, double near_m) const {
    const bool near = std::any_of(lines.begin(), lines.end(), [&](const PlanLine& line) {
      return std::abs(line.normal.dot(normal)) > 0.9 && std::abs(line.distance(point)) <= near_m;
    });
    if (!near && lines.size() < Arrangement::max_lines) lines.push_back({normal, -normal.dot(point)});
  }

  // Where no wall was seen the room ends where free space does, in the direction most of its walls have.
  void add_bounds(std::vector<PlanLine>& lines) const {
    double cosine = 0, sine = 0;  // of four times the angle: walls square to one another agree
    for (const std::size_t w : nearby_) {
      const double angle = 4 * std::atan2(walls_[w].normal().y(), walls_[w].normal().x());
      cosine += walls_[w].seen_m() * std::cos(angle);
      sine += walls_[w].seen_m() * std::sin(angle);
    }
    const double turn = 0.25 * std::atan2(sine, cosine);
    const std::vector<Eigen::Vector2d> cells = cells_of(cluster_, map_, clusters_);
    const std::size_t trimmed = cells.size() / 100;  // a few rays stray
    for (int k = 0; k < 4; ++k) {
      const double angle = turn + k * std::numbers::pi / 2;
      const Eigen::Vector2d outward(std::cos(angle), std::sin(angle));
      std::vector<double> reach;
      for (const Eigen::Vector2d& p : cells) reach.push_back(outward.dot(p));
      std::nth_element(reach.begin(), reach.end() - 1 - static_cast<std::ptrdiff_t>(trimmed), reach.end());
      const double farthest = reach[reach.size() - 1 - trimmed] + 0.5 * map_.frame.cell_m;
      const bool bounded = std::any_of(lines.begin(), lines.end(), [&](const PlanLine& line) {
        return std::abs(line.normal.dot(outward)) > 0.9 &&
               std::abs(farthest + line.offset_m * line.normal.dot(outward)) < 0.6;
      });
      if (!bounded && lines.size() < Arrangement::max_lines) lines.push_back({-outward, farthest});
    }
  }

  int cluster_;
  const LevelMap& map_;
  const Clusters& clusters_;
  std::span<const WallLine> walls_;
  std::span<const std::size_t> nearby_;
  const OutlineOptions& options_;
};

}  // namespace

std::vector<Eigen::Vector2d> cells_of(int cluster, const LevelMap& map, const Clusters& clusters) {
  std::vector<Eigen::Vector2d> cells;
  for (int i = 0; i < map.frame.size(); ++i)
    if (clusters.labels[static_cast<std::size_t>(i)] == cluster) cells.push_back(map.frame.center(i));
  return cells;
}

std::vector<std::size_t> walls_around(int cluster, const LevelMap& map, const Clusters& clusters,
                                      std::span<const WallLine> walls, const OutlineOptions& options) {
  std::vector<std::size_t> around;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    double near_m = 0;
    for (double t = walls[w].from_m() + 0.5 * step_m; t < walls[w].to_m() + 0.5 * step_m; t += step_m)
      if (walls[w].seen_m(t - 0.5 * step_m, t + 0.5 * step_m, false) > 0 &&
          cluster_before(map, clusters, walls[w], t, options.proximity_m) == cluster)
        near_m += step_m;
    if (near_m >= options.min_wall_m) around.push_back(w);
  }
  return around;
}

std::vector<PlanLine> outline_lines(int cluster, const LevelMap& map, const Clusters& clusters,
                                    std::span<const WallLine> walls, std::span<const std::size_t> nearby,
                                    const OutlineOptions& options) {
  return LineCollector(cluster, map, clusters, walls, nearby, options).collect();
}

}  // namespace vsgraphs
