#include "core/scene/rooms/basins.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace vsgraphs {
namespace {

class Flood {
 public:
  Flood(const GridFrame& frame, const GridValues<float>& clearance_m, double min_persistence_m,
        const std::function<bool(const Narrowing&)>& divides)
      : frame_(frame),
        clearance_(clearance_m),
        min_persistence_m_(min_persistence_m),
        divides_(divides),
        parent_(clearance_m.size(), -1) {}

  Basins run() {
    std::vector<int> order;
    for (int i = 0; i < frame_.size(); ++i)
      if (at(i) > 0) order.push_back(i);
    std::sort(order.begin(), order.end(),
              [this](int a, int b) { return at(a) != at(b) ? at(a) > at(b) : a < b; });
    for (const int cell : order) add(cell);
    return labelled();
  }

 private:
  float at(int cell) const { return clearance_[static_cast<std::size_t>(cell)]; }
  int& parent(int cell) { return parent_[static_cast<std::size_t>(cell)]; }

  int root(int cell) {
    while (parent(cell) != cell) cell = parent(cell) = parent(parent(cell));
    return cell;
  }

  // A basin's root is its peak: cells come in descending order, and the lower peak is hung below the higher.
  void add(int cell) {
    int home = cell;
    parent(cell) = cell;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2i next = frame_.cell(cell) + grid_neighbours[k];
      if (!frame_.inside(next) || parent(frame_.index(next)) < 0) continue;
      const int other = root(frame_.index(next));
      if (other == home) continue;
      if (home == cell) {
        parent(cell) = home = other;
      } else if (!apart(home, other, cell)) {
        const bool first = at(home) != at(other) ? at(home) > at(other) : home < other;
        parent(first ? other : home) = first ? home : other;
        home = first ? home : other;
      }
    }
  }

  bool apart(int a, int b, int saddle) {
    const double lower_peak = std::min(at(a), at(b)), here = at(saddle);
    const Eigen::Vector2d center = frame_.center(saddle);
    for (const WallOpening& known : openings_)  // the edges of a gap that has been judged already
      if ((center - known.center).norm() <= 0.5 * known.width_m + 2 * frame_.cell_m) return true;
    if (lower_peak < here + min_persistence_m_) return false;
    const std::optional<WallOpening> gap = gap_at(saddle);
    if (!gap || !divides_({*gap, here, lower_peak})) return false;
    openings_.push_back(*gap);
    return true;
  }

  // The shortest line across: from the nearest obstacle to the nearest one on the other side.
  std::optional<WallOpening> gap_at(int saddle) const {
    const Eigen::Vector2d center = frame_.center(saddle);
    const auto first = nearest_obstacle(center, at(saddle) + 2 * frame_.cell_m, Eigen::Vector2d::Zero());
    if (!first) return std::nullopt;
    const Eigen::Vector2d there = *first - center;
    const auto second = nearest_obstacle(center, 2 * at(saddle) + 4 * frame_.cell_m, -there.normalized());
    if (!second) return std::nullopt;
    const Eigen::Vector2d across = *second - *first;
    const Eigen::Vector2d axis = across.normalized();
    return WallOpening{0.5 * (*first + *second), {axis.y(), -axis.x()}, across.norm() - frame_.cell_m, 0};
  }

  // `towards`: unit, or zero for any direction.
  std::optional<Eigen::Vector2d> nearest_obstacle(const Eigen::Vector2d& from, double radius,
                                                  const Eigen::Vector2d& towards) const {
    const int reach = static_cast<int>(std::ceil(radius / frame_.cell_m));
    const Eigen::Vector2i middle = frame_.cell_at(from);
    std::optional<Eigen::Vector2d> best;
    double best_distance = radius;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const Eigen::Vector2i cell = middle + Eigen::Vector2i(dx, dy);
        const Eigen::Vector2d way = Eigen::Vector2d(dx, dy) * frame_.cell_m;
        const double distance = way.norm();
        if (distance == 0 || distance >= best_distance || way.dot(towards) < 0.7 * distance * towards.norm())
          continue;
        if (frame_.inside(cell) && at(frame_.index(cell)) > 0) continue;
        best = from + way;
        best_distance = distance;
      }
    return best;
  }

  Basins labelled() {
    Basins basins{GridValues<int>(clearance_.size(), -1), 0, openings_};
    std::vector<int> label_of_root(clearance_.size(), -1);
    for (int i = 0; i < frame_.size(); ++i) {
      if (parent(i) < 0) continue;
      int& label = label_of_root[static_cast<std::size_t>(root(i))];
      if (label < 0) label = basins.count++;
      basins.labels[static_cast<std::size_t>(i)] = label;
    }
    return basins;
  }

  const GridFrame& frame_;
  const GridValues<float>& clearance_;
  double min_persistence_m_;
  const std::function<bool(const Narrowing&)>& divides_;
  std::vector<int> parent_;  // -1: not flooded yet
  std::vector<WallOpening> openings_;
};

}  // namespace

Basins find_basins(const GridFrame& frame, const GridValues<float>& clearance_m, double min_persistence_m,
                   const std::function<bool(const Narrowing&)>& divides) {
  return Flood(frame, clearance_m, min_persistence_m, divides).run();
}

}  // namespace vsgraphs
