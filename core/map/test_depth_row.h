// A depth grid of one row, for tests that need keyframes with some depth.
#pragma once

#include <memory>
#include <utility>

#include "core/map/depth_grid.h"

namespace vsgraphs::test {

// Four readings 0.2 m apart on a surface 2 m ahead that faces the camera.
inline std::shared_ptr<const DepthGrid> depth_row() {
  DepthGrid grid;
  grid.columns = 4;
  grid.rows = 1;
  for (int s = 0; s < 4; ++s)
    grid.samples.push_back({{0.2F * static_cast<float>(s), 0, 2}, -Eigen::Vector3f::UnitZ()});
  return std::make_shared<const DepthGrid>(std::move(grid));
}

}  // namespace vsgraphs::test
