// What rooms and doors are found in: voxels, and where they were seen from, in one levelled frame (z up, metres).
#pragma once

#include <utility>
#include <vector>

#include "core/scene/space/free_space.h"

namespace vsgraphs {

// The voxels belong to somebody else and must outlive it.
struct SpaceView {
  SpaceView(const VoxelBlocks& its_voxels, double its_voxel_m, std::vector<FreeSpace::View> its_views)
      : voxels(its_voxels), voxel_m(its_voxel_m), views(std::move(its_views)) {}
  // All of it as it is. Converts by itself: one grid is such a view already.
  SpaceView(const FreeSpace& space) : voxels(space.voxels()), voxel_m(space.options().voxel_m) {
    for (const auto& [keyframe, view] : space.views()) views.push_back(view);
  }

  const VoxelBlocks& voxels;
  double voxel_m;
  std::vector<FreeSpace::View> views;  // by keyframe; some without depth
};

}  // namespace vsgraphs
