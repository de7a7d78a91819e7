// Undistortion by table: Newton per feature would cost as much as finding the features.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/camera.h"

namespace vsgraphs {

class UndistortGrid {
 public:
  // Solves the camera's undistortion at every fourth pixel (about 30 ms once; nothing without distortion).
  explicit UndistortGrid(const Camera& camera);

  // Distorted pixel -> pinhole pixel, bilinear between nodes; within 0.01 px for lenses in common use.
  Eigen::Vector2f at(float raw_u, float raw_v) const;

 private:
  static constexpr int step_px = 4;
  int columns_ = 0, rows_ = 0;
  std::vector<Eigen::Vector2f> shift_;  // pinhole minus distorted pixel at the nodes; empty: no distortion
};

}  // namespace vsgraphs
