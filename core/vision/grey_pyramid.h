// A grey image at falling sizes, each level made from the one before it, with a smoothed copy of every level.
// Buffers are allocated once and shared by all levels at one stride, so that a table of pixel offsets made
// for one level serves them all.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

class GreyPyramid {
 public:
  GreyPyramid(const ScalePyramid& scales, int width, int height);

  // Fills every level; level 0 stays a view of `grey`, which must outlive the use of this pyramid.
  void build(const ImageView<std::uint8_t>& grey);

  int levels() const { return static_cast<int>(levels_.size()); }
  const ImageView<std::uint8_t>& level(int i) const { return levels_[static_cast<std::size_t>(i)].grey; }
  // Smoothed by the 7-tap kernel (1 2 3 4 3 2 1)/16 in both directions (sigma 1.58 px).
  const ImageView<std::uint8_t>& blurred(int i) const { return levels_[static_cast<std::size_t>(i)].blurred; }
  std::ptrdiff_t blurred_stride() const { return stride_; }

 private:
  // Where an output pixel falls between two input pixels: `weight`/128 of the second one.
  struct Tap {
    int first;
    int weight;
  };
  // Sixteen source pixels from `base` hold all that eight output pixels need.
  struct TapGroup {
    int base;
    std::uint8_t pick[16];      // left neighbours of the eight outputs, then right neighbours
    std::uint16_t weights[16];  // in 1/128, same order
  };
  struct Level {
    ImageView<std::uint8_t> grey, blurred;
    std::uint8_t* grey_pixels = nullptr;  // null for level 0
    std::uint8_t* blurred_pixels = nullptr;
    std::vector<Tap> row_taps;
    std::vector<TapGroup> column_taps;
  };
  static std::vector<Tap> taps(int from, int to);
  static std::vector<TapGroup> group(const std::vector<Tap>& taps, int from);
  void shrink(const ImageView<std::uint8_t>& from, const Level& to);
  void blur(const Level& level);

  std::ptrdiff_t stride_ = 0;
  std::vector<Level> levels_;
  std::vector<std::uint8_t> grey_store_, blurred_store_, row_;
  std::vector<std::uint16_t> sums_;
};

}  // namespace vsgraphs
