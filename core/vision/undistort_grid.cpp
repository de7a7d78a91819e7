#include "core/vision/undistort_grid.h"

#include <algorithm>

namespace vsgraphs {

UndistortGrid::UndistortGrid(const Camera& camera) {
  if (!camera.distorted()) return;
  columns_ = camera.width / step_px + 2;  // the last node lies on or beyond the last pixel
  rows_ = camera.height / step_px + 2;
  shift_.reserve(static_cast<std::size_t>(columns_) * rows_);
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      const Eigen::Vector2d node(c * step_px, r * step_px);
      shift_.push_back((camera.undistort(node) - node).cast<float>());
    }
  }
}

Eigen::Vector2f UndistortGrid::at(float raw_u, float raw_v) const {
  const Eigen::Vector2f raw(raw_u, raw_v);
  if (shift_.empty()) return raw;
  const float x = raw_u / step_px, y = raw_v / step_px;
  const int c = std::clamp(static_cast<int>(x), 0, columns_ - 2);
  const int r = std::clamp(static_cast<int>(y), 0, rows_ - 2);
  const float fx = x - static_cast<float>(c), fy = y - static_cast<float>(r);
  const Eigen::Vector2f* node = &shift_[static_cast<std::size_t>(r) * columns_ + c];
  const Eigen::Vector2f top = node[0] * (1 - fx) + node[1] * fx;
  const Eigen::Vector2f bottom = node[columns_] * (1 - fx) + node[columns_ + 1] * fx;
  return raw + top * (1 - fy) + bottom * fy;
}

}  // namespace vsgraphs
