// A coarse copy of one depth image: a surface point and normal every few pixels. What tracking aligns when corners
// are rare; kept with keyframes (about 100 kB).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/base/fields.h"

namespace vsgraphs {

struct SurfaceSample {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();  // m, camera frame; z = 0: no reading
  Eigen::Vector3f normal =
      Eigen::Vector3f::Zero();  // unit, towards the camera; zero: not on a smooth surface
  bool has_normal() const { return normal.squaredNorm() > 0; }
};
template <FieldsOf<SurfaceSample> T>
void visit_fields(T& v, auto& field) {
  auto& [point, normal] = v;
  field(point, normal);
}

struct DepthGrid {
  int step_px = 8;  // sample (c, r) is the distorted pixel (c * step + step / 2, r * step + step / 2)
  int columns = 0, rows = 0;
  std::vector<SurfaceSample> samples;  // row by row

  const SurfaceSample& at(int column, int row) const {
    return samples[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  }
};
template <>
inline constexpr const char* shared_name<DepthGrid> = "depth_grids";
template <FieldsOf<DepthGrid> T>
void visit_fields(T& v, auto& field) {
  auto& [step_px, columns, rows, samples] = v;
  field(step_px, columns, rows, samples);
  if constexpr (std::remove_reference_t<decltype(field)>::reads) {
    const bool sized = columns >= 0 && rows >= 0 && step_px > 0 && columns < 65536 && rows < 65536;
    field.require(
        sized && samples.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
        "a depth grid of another size than its samples");
  }
}

}  // namespace vsgraphs
