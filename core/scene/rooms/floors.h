// Floors: rooms that stand on one horizontal plane. vS-Graphs, section "Structural Element Recognition" (floors), with
// the co-planarity test the paper leaves out, so several storeys are several floors.
#pragma once

#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/map/structure.h"

namespace vsgraphs {

struct FloorOptions {
  double tolerance_m = 0.3;
};

template <typename Visitor>
void describe(FloorOptions& o, Visitor& field) {
  field("tolerance_m", o.tolerance_m, 0.02, 1.5,
        "largest difference in height between the grounds of rooms on one floor, in metres");
}

// Ascending by height. `rooms` are numbered.
std::vector<FoundFloor> find_floors(std::span<const FoundRoom> rooms, const FloorOptions& options);

}  // namespace vsgraphs
