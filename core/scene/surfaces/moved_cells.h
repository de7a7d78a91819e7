// Cells counted in one frame of a plane, as another frame of it has them: each new cell takes what lies at its middle, so that
// no holes appear where the two are turned against each other.
#pragma once

#include <algorithm>

#include "core/scene/surfaces/plane_extent.h"

namespace vsgraphs {

// visit(cell of `to`, value) for every cell whose value is not the default one.
template <typename Value>
void for_moved_cells(const CellGrid<Value>& cells, const PlaneFrame& from, const PlaneFrame& to,
                     double cell_m, const auto& visit) {
  if (cells.empty()) return;
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (const int s : {cells.min_s(), cells.end_s()}) {
    for (const int t : {cells.min_t(), cells.end_t()}) {
      const Eigen::Array2d corner = to.coordinates(from.point(s * cell_m, t * cell_m)).array();
      low = low.min(corner);
      high = high.max(corner);
    }
  }
  if (!(high.abs().max(low.abs()).maxCoeff() < 2 * PlaneExtent::farthest_m)) return;
  const Cell first = cell_at(low.x(), low.y(), cell_m), last = cell_at(high.x(), high.y(), cell_m);
  for (int t = first.t; t <= last.t; ++t) {
    for (int s = first.s; s <= last.s; ++s) {
      const Eigen::Vector2d there = from.coordinates(to.point((s + 0.5) * cell_m, (t + 0.5) * cell_m));
      const Value value = cells.at(cell_at(there.x(), there.y(), cell_m));
      if (!(value == Value{})) visit(Cell{s, t}, value);
    }
  }
}

}  // namespace vsgraphs
