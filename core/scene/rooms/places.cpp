#include "core/scene/rooms/places.h"

#include <algorithm>
#include <cmath>
#include <compare>

namespace vsgraphs {
namespace {

bool sees(const LevelMap& map, const Clusters& clusters, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / (0.5 * map.frame.cell_m))));
  for (int i = 0; i <= steps; ++i) {
    const int index = map.frame.index_at(a + (b - a) * i / steps);
    if (index < 0) return false;
    const auto cell = static_cast<std::size_t>(index);
    // Openings have no clearance of their own: they are cuts.
    if (clusters.clearance_m[cell] <= 0 && map.cells[cell] != CellState::open) return false;
  }
  return true;
}

class PlaceBuilder {
 public:
  PlaceBuilder(const LevelMap& map, const Clusters& clusters, const RoomsOfLevel& rooms,
               const PlaceOptions& options)
      : map_(map), clusters_(clusters), rooms_(rooms), options_(options) {}

  std::vector<Place> build() {
    for (const ClusterOpening& o : clusters_.openings)
      if (o.clusters[0] >= 0 && o.clusters[1] >= 0) add(o.opening.center, 0.5 * o.opening.width_m, no_room);
    std::vector<int> cells;
    for (int i = 0; i < map_.frame.size(); ++i)
      if (label(i) >= 0 && clearance(i) >= options_.min_clearance_m) cells.push_back(i);
    std::sort(cells.begin(), cells.end(), [this](int a, int b) {
      return clearance(a) != clearance(b) ? clearance(a) > clearance(b) : a < b;
    });
    for (const int cell : cells) {
      const Eigen::Vector2d center = map_.frame.center(cell);
      const double spacing = std::max(options_.spacing_m, 0.7 * clearance(cell));
      if (std::none_of(places_.begin(), places_.end(),
                       [&](const Place& p) { return (p.position.head<2>() - center).norm() < spacing; }))
        add(center, clearance(cell), room_of(label(cell)));
    }
    join();
    return std::move(places_);
  }

 private:
  int label(int cell) const { return clusters_.labels[static_cast<std::size_t>(cell)]; }
  double clearance(int cell) const { return clusters_.clearance_m[static_cast<std::size_t>(cell)]; }
  RoomNumber room_of(int cluster) const {
    const int room = rooms_.room_of_cluster[static_cast<std::size_t>(cluster)];
    return room < 0 ? no_room : rooms_.rooms[static_cast<std::size_t>(room)].number;
  }
  void add(const Eigen::Vector2d& at, double clearance_m, RoomNumber room) {
    places_.push_back({{at.x(), at.y(), map_.ground_m}, clearance_m, room, {}});
  }

  struct Edge {
    double length;
    std::uint32_t a, b;
    auto operator<=>(const Edge&) const = default;
  };

  std::vector<Edge> possible_edges() const {
    std::vector<Edge> edges;
    for (std::uint32_t a = 0; a < places_.size(); ++a)
      for (std::uint32_t b = a + 1; b < places_.size(); ++b) {
        const Place &p = places_[a], &q = places_[b];
        if (p.room != q.room && p.room != no_room && q.room != no_room) continue;
        const double length = (p.position - q.position).norm();
        const double reach =
            1.2 * (std::max(options_.spacing_m, p.clearance_m) + std::max(options_.spacing_m, q.clearance_m));
        if (length <= reach && sees(map_, clusters_, p.position.head<2>(), q.position.head<2>()))
          edges.push_back({length, a, b});
      }
    return edges;
  }

  // An edge goes if two shorter ones lead the same way: what is connected stays connected.
  void join() {
    std::vector<Edge> edges = possible_edges();
    std::sort(edges.begin(), edges.end());
    std::vector<std::vector<Edge>> shorter(places_.size());  // from each place, by what has been looked at
    const auto joined = [&](std::uint32_t a, std::uint32_t b) {
      return std::any_of(shorter[a].begin(), shorter[a].end(),
                         [&](const Edge& e) { return e.a == b || e.b == b; });
    };
    for (const Edge& edge : edges) {
      const bool detour = std::any_of(shorter[edge.a].begin(), shorter[edge.a].end(), [&](const Edge& e) {
        return joined(edge.b, e.a == edge.a ? e.b : e.a);
      });
      shorter[edge.a].push_back(edge);
      shorter[edge.b].push_back(edge);
      if (detour) continue;
      places_[edge.a].neighbours.push_back(edge.b);
      places_[edge.b].neighbours.push_back(edge.a);
    }
    for (Place& p : places_) std::sort(p.neighbours.begin(), p.neighbours.end());
  }

  const LevelMap& map_;
  const Clusters& clusters_;
  const RoomsOfLevel& rooms_;
  const PlaceOptions& options_;
  std::vector<Place> places_;
};

}  // namespace

std::vector<Place> find_places(const LevelMap& map, const Clusters& clusters, const RoomsOfLevel& rooms,
                               const PlaceOptions& options) {
  return PlaceBuilder(map, clusters, rooms, options).build();
}

}  // namespace vsgraphs
