// A grid over the ground plan, aligned with the columns of the voxel grid.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace vsgraphs {

// Which square metres a grid covers. Frame: levelled, seen from above, metres.
struct GridFrame {
  Eigen::Vector2i origin{0, 0};  // of cell (0, 0), in cells
  double cell_m = 0.1;
  int width = 0, height = 0;

  int size() const { return width * height; }
  bool inside(const Eigen::Vector2i& cell) const {
    return cell.x() >= 0 && cell.y() >= 0 && cell.x() < width && cell.y() < height;
  }
  int index(const Eigen::Vector2i& cell) const { return cell.y() * width + cell.x(); }
  Eigen::Vector2i cell(int index) const { return {index % width, index / width}; }
  Eigen::Vector2i cell_at(const Eigen::Vector2d& point) const {
    return Eigen::Vector2i(static_cast<int>(std::floor(point.x() / cell_m)),
                           static_cast<int>(std::floor(point.y() / cell_m))) -
           origin;
  }
  // -1 outside.
  int index_at(const Eigen::Vector2d& point) const {
    const Eigen::Vector2i at = cell_at(point);
    return inside(at) ? index(at) : -1;
  }
  Eigen::Vector2d center(int i) const {
    return (cell(i) + origin).cast<double>() * cell_m + Eigen::Vector2d::Constant(0.5 * cell_m);
  }
  double cell_area_m2() const { return cell_m * cell_m; }
  bool operator==(const GridFrame&) const = default;
};

// One value per cell of a frame, row by row.
template <typename T>
using GridValues = std::vector<T>;

inline const Eigen::Vector2i grid_neighbours[8] = {{1, 0}, {0, 1},  {-1, 0},  {0, -1},
                                                   {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};  // 4 sides first

}  // namespace vsgraphs
