// Watershed of a clearance field: basins around its peaks, joined unless the narrow place between them is an opening.
#pragma once

#include <functional>
#include <vector>

#include "core/scene/rooms/grid.h"
#include "core/scene/rooms/openings.h"

namespace vsgraphs {

struct Basins {
  GridValues<int> labels;  // 0..count-1, -1 where clearance is 0
  int count = 0;
  std::vector<WallOpening> openings;  // narrow places that were taken for openings
};

// A narrow place: the gap, and the clearance at it and at the lower of the two peaks it divides.
struct Narrowing {
  WallOpening gap;
  double clearance_m = 0, lower_peak_m = 0;
};

// `divides` judges each narrow place where two basins meet whose peaks rise `min_persistence_m` above it. Deterministic;
// sorts the cells once.
Basins find_basins(const GridFrame& frame, const GridValues<float>& clearance_m, double min_persistence_m,
                   const std::function<bool(const Narrowing&)>& divides);

}  // namespace vsgraphs
