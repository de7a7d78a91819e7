// Internal to core/simulate: noise whose neighbours are alike.
#pragma once

#include <vector>

#include "core/base/rng.h"

namespace vsgraphs {

// Noise that varies smoothly from pixel to pixel: independent values on a coarse grid, blended bilinearly.
class SmoothNoise {
 public:
  SmoothNoise(Rng& rng, int width, int height, int spacing, bool gaussian)
      : spacing_(spacing),
        columns_(width / spacing + 2),
        nodes_(static_cast<std::size_t>(columns_) * (height / spacing + 2)),
        row_(static_cast<std::size_t>(columns_)) {
    for (float& n : nodes_) n = static_cast<float>(gaussian ? rng.normal() : rng.uniform());
  }
  void select_row(int v) {
    const int j = v / spacing_;
    const float f = static_cast<float>(v % spacing_) / static_cast<float>(spacing_);
    const float* a = nodes_.data() + static_cast<std::ptrdiff_t>(j) * columns_;
    for (int i = 0; i < columns_; ++i)
      row_[static_cast<std::size_t>(i)] = (1 - f) * a[i] + f * a[i + columns_];
  }
  float at(int u) const {
    const int i = u / spacing_;
    const float f = static_cast<float>(u % spacing_) / static_cast<float>(spacing_);
    return (1 - f) * row_[static_cast<std::size_t>(i)] + f * row_[static_cast<std::size_t>(i) + 1];
  }

 private:
  int spacing_, columns_;
  std::vector<float> nodes_, row_;
};

// Blended uniform noise keeps to the middle of 0..1; this spreads it nearly evenly again.
inline float spread_evenly(float x) { return x < 0.5f ? 2 * x * x : 1 - 2 * (1 - x) * (1 - x); }

// Blending 2 x 2 independent values averages their variance down to 4/9 over the cell.
inline constexpr float blend_gain = 1.5f;

}  // namespace vsgraphs
