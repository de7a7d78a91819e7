// Internal to core/simulate: noise whose neighbours are alike.
#pragma once

#include <vector>

#include "core/base/rng.h"

namespace vsgraphs {

// A number of zero mean and unit spread that costs a tenth of Rng::normal(): four uniform ones added up (Irwin and Hall), within 3.5 spreads.
inline float bell(Rng& rng) {
  const std::uint64_t bits = rng.next();
  const std::uint64_t sum = (bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48);
  return (static_cast<float>(static_cast<std::int32_t>(sum)) * (1.0f / 65536) - 2.0f) * 1.7320508f;
}

enum class Drawn { uniform, normal, bell };

// Noise that varies smoothly from pixel to pixel: independent values on a coarse grid, blended bilinearly.
class SmoothNoise {
 public:
  SmoothNoise(Rng& rng, int width, int height, int spacing, Drawn drawn)
      : spacing_(spacing),
        columns_(width / spacing + 2),
        nodes_(static_cast<std::size_t>(columns_) * (height / spacing + 2)),
        row_(static_cast<std::size_t>(columns_)),
        places_(static_cast<std::size_t>(width)) {
    for (float& n : nodes_) n = number(rng, drawn);
    for (int u = 0; u < width; ++u)
      places_[static_cast<std::size_t>(u)] = {u / spacing,
                                              static_cast<float>(u % spacing) / static_cast<float>(spacing)};
  }
  void select_row(int v) {
    const int j = v / spacing_;
    const float f = static_cast<float>(v % spacing_) / static_cast<float>(spacing_);
    const float* a = nodes_.data() + static_cast<std::ptrdiff_t>(j) * columns_;
    for (int i = 0; i < columns_; ++i)
      row_[static_cast<std::size_t>(i)] = (1 - f) * a[i] + f * a[i + columns_];
  }
  float at(int u) const {
    const Place& place = places_[static_cast<std::size_t>(u)];
    const float* here = row_.data() + place.node;
    return (1 - place.share) * here[0] + place.share * here[1];
  }

 private:
  struct Place {
    int node;
    float share;  // of the next node
  };
  static float number(Rng& rng, Drawn drawn) {
    if (drawn == Drawn::bell) return bell(rng);
    return static_cast<float>(drawn == Drawn::normal ? rng.normal() : rng.uniform());
  }

  int spacing_, columns_;
  std::vector<float> nodes_, row_;
  std::vector<Place> places_;  // of the row's pixels
};

// Blended uniform noise keeps to the middle of 0..1; this spreads it nearly evenly again.
inline float spread_evenly(float x) { return x < 0.5f ? 2 * x * x : 1 - 2 * (1 - x) * (1 - x); }

// Blending 2 x 2 independent values averages their variance down to 4/9 over the cell.
inline constexpr float blend_gain = 1.5f;

}  // namespace vsgraphs
