#include "core/map/features.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace vsgraphs {

FeatureSet::FeatureSet(std::vector<Feature> features, std::vector<Descriptor> descriptors, int width,
                       int height)
    : features_(std::move(features)),
      descriptors_(std::move(descriptors)),
      columns_((width + cell_px - 1) / cell_px),
      rows_((height + cell_px - 1) / cell_px) {
  VSG_INVARIANT(features_.size() == descriptors_.size());
  VSG_INVARIANT(features_.size() <= 65535);
  // Counting sort by cell: two passes, no allocation per cell.
  cell_begin_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
  const auto cell_of = [this](const Feature& f) {
    return static_cast<std::size_t>(row(f.v)) * columns_ + column(f.u);
  };
  for (const Feature& f : features_) ++cell_begin_[cell_of(f) + 1];
  for (std::size_t c = 1; c < cell_begin_.size(); ++c) cell_begin_[c] += cell_begin_[c - 1];
  cell_items_.resize(features_.size());
  std::vector<std::uint32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
  for (std::size_t i = 0; i < features_.size(); ++i) {
    cell_items_[next[cell_of(features_[i])]++] = static_cast<std::uint16_t>(i);
  }
}

bool FeatureSet::consistent() const {
  constexpr int most_cells = 1 << 12;  // a side: 65,536 px
  const bool sized = columns_ >= 0 && rows_ >= 0 && columns_ <= most_cells && rows_ <= most_cells;
  const bool housed = features_.empty() || (columns_ > 0 && rows_ > 0);
  constexpr float most_px = 1e6F, nearest_m = 1e-6F;  // its inverse is a number
  return sized && housed && features_.size() == descriptors_.size() && features_.size() <= 65535 &&
         std::all_of(features_.begin(), features_.end(), [](const Feature& f) {
           return std::abs(f.u) < most_px && std::abs(f.v) < most_px &&
                  (f.depth_m == 0 || f.depth_m > nearest_m) && f.depth_m < most_px &&
                  std::abs(f.angle_rad) < 10 && f.level < 16;
         });
}

// Undistorted features may lie a little outside the image; they live in the border cells.
int FeatureSet::column(float u) const { return std::clamp(static_cast<int>(u) / cell_px, 0, columns_ - 1); }
int FeatureSet::row(float v) const { return std::clamp(static_cast<int>(v) / cell_px, 0, rows_ - 1); }

void FeatureSet::in_area(float u, float v, float radius_px, int min_level, int max_level,
                         std::vector<int>& out) const {
  if (features_.empty()) return;
  const int c0 = column(u - radius_px), c1 = column(u + radius_px);
  const int r0 = row(v - radius_px), r1 = row(v + radius_px);
  for (int r = r0; r <= r1; ++r) {
    // Cells of one row are neighbours in cell_items_, so a row of cells is one run.
    const std::size_t base = static_cast<std::size_t>(r) * columns_;
    for (std::uint32_t k = cell_begin_[base + c0]; k < cell_begin_[base + c1 + 1]; ++k) {
      const Feature& f = features_[cell_items_[k]];
      if (f.level < min_level || f.level > max_level) continue;
      if (std::abs(f.u - u) < radius_px && std::abs(f.v - v) < radius_px) out.push_back(cell_items_[k]);
    }
  }
}

}  // namespace vsgraphs
