// A coarse copy of one depth image: a surface point and normal every few pixels. What tracking aligns when corners
// are rare; kept with keyframes (about 100 kB).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace vsgraphs {

struct SurfaceSample {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();  // m, camera frame; z = 0: no reading
  Eigen::Vector3f normal =
      Eigen::Vector3f::Zero();  // unit, towards the camera; zero: not on a smooth surface
  bool has_normal() const { return normal.squaredNorm() > 0; }
};

struct DepthGrid {
  int step_px = 8;  // sample (c, r) is the distorted pixel (c * step + step / 2, r * step + step / 2)
  int columns = 0, rows = 0;
  std::vector<SurfaceSample> samples;  // row by row

  const SurfaceSample& at(int column, int row) const {
    return samples[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  }
};

}  // namespace vsgraphs
