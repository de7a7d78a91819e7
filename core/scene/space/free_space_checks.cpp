#include "core/scene/space/free_space_checks.h"

#include <utility>

#include "core/geometry/bounds.h"

namespace vsgraphs {

namespace {

// A visitor of options (core/base/options.h).
struct Ranges {
  bool kept = true;
  template <typename Number>
  void operator()(const char*, Number& value, Number low, Number high, const char*) {
    kept = kept && value >= low && value <= high;
  }
};

bool in_range(FreeSpaceOptions options) {
  Ranges ranges;
  describe(options, ranges);
  return ranges.kept;
}

using Corners = std::pair<Eigen::Array3d, Eigen::Array3d>;

// What rays can have reached, in voxels.
Corners reach_of(const FreeSpace& space) {
  Corners reach{Eigen::Array3d::Constant(1), Eigen::Array3d::Constant(0)};
  bool first = true;
  for (const auto& [id, view] : space.views()) {
    const Eigen::Array3d at = view.level_from_camera.translation() / space.options().voxel_m;
    reach.first = first ? at : reach.first.min(at);
    reach.second = first ? at : reach.second.max(at);
    first = false;
  }
  const double far = space.options().range_m / space.options().voxel_m + 2;
  return {reach.first - far, reach.second + far};
}

// Nothing was ever seen so far off; what a view has left behind when it was moved is empty.
bool out_of_reach(const VoxelBlocks::Block& block, const Corners& reach) {
  const Eigen::Array3d low = block.origin.cast<double>(), high = low + VoxelBlocks::edge;
  const bool outside = (high < reach.first).any() || (low > reach.second).any();
  return outside && (!within(block.origin.cast<double>(), 2 * most_metres / 0.05) || !block.empty());
}

}  // namespace

Wrong wrong_with_free_space(const FreeSpace& space, const Map& map) {
  for (const auto& [id, view] : space.views()) {
    if (!map.retired_keyframes().contains(id)) return "free space seen by a keyframe that does not exist";
  }
  return wrong_with_free_space(space);
}

Wrong wrong_with_free_space(const FreeSpace& space) {
  if (!in_range(space.options())) return "free space of no resolution";
  for (const auto& [id, view] : space.views()) {
    if (!is_pose(view.level_from_camera) || (view.depth && !is_sane(*view.depth)))
      return "free space seen from nowhere";
  }
  const Corners reach = reach_of(space);
  for (const VoxelBlocks::Block& block : space.voxels().blocks()) {
    if (out_of_reach(block, reach)) return "free space where nobody looked";
  }
  return nullptr;
}

}  // namespace vsgraphs
