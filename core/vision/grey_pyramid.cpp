#include "core/vision/grey_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/check.h"
#include "core/vision/simd.h"

namespace vsgraphs {
namespace {

constexpr int lanes = 8;
constexpr int blur_reach = 3;

// The loops below are functions of their own with __restrict, without which the compiler must expect bytes to
// alias everything and does not vectorise (a factor of three over the whole pyramid).

// `weight`/128 of the way from one row to the other.
void mix(const std::uint8_t* __restrict above, const std::uint8_t* __restrict below, int weight, int width,
         std::uint8_t* __restrict out) {
  const auto w = static_cast<std::uint16_t>(weight), rest = static_cast<std::uint16_t>(128 - weight);
  for (int u = 0; u < width; ++u) {
    out[u] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(above[u] * rest + below[u] * w + 64) >> 7);
  }
}

void sum_rows(const std::uint8_t* const* rows, int width, std::uint16_t* __restrict out) {
  const std::uint8_t* __restrict a = rows[0], * __restrict b = rows[1], * __restrict c = rows[2];
  const std::uint8_t* __restrict d = rows[3], * __restrict e = rows[4], * __restrict f = rows[5];
  const std::uint8_t* __restrict g = rows[6];
  for (int u = 0; u < width; ++u) {
    out[u] = static_cast<std::uint16_t>(a[u] + g[u] + 2 * (b[u] + f[u]) + 3 * (c[u] + e[u]) + 4 * d[u]);
  }
}

void sum_columns(const std::uint16_t* __restrict s, int width, std::uint8_t* __restrict out) {
  for (int u = 0; u < width; ++u) {
    const auto sum = static_cast<std::uint16_t>(s[u] + s[u + 6] + 2 * (s[u + 1] + s[u + 5]) +
                                                3 * (s[u + 2] + s[u + 4]) + 4 * s[u + 3] + 128);
    out[u] = static_cast<std::uint8_t>(sum >> 8);
  }
}

}  // namespace

GreyPyramid::GreyPyramid(const ScalePyramid& scales, int width, int height)
    : stride_((width + 63) / 64 * 64), levels_(static_cast<std::size_t>(scales.levels)) {
  std::size_t rows = 0;
  for (int i = 0; i < scales.levels; ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    level.grey.width = level.blurred.width = static_cast<int>(std::lround(width / scales.scale(i)));
    level.grey.height = level.blurred.height = static_cast<int>(std::lround(height / scales.scale(i)));
    level.grey.stride = level.blurred.stride = stride_;
    rows += static_cast<std::size_t>(level.grey.height);
  }
  const std::size_t size = rows * static_cast<std::size_t>(stride_);
  grey_store_.resize(size);
  blurred_store_.resize(size);
  row_.resize(static_cast<std::size_t>(stride_));
  sums_.resize(static_cast<std::size_t>(stride_) + 2 * blur_reach);
  std::ptrdiff_t offset = 0;
  for (int i = 0; i < scales.levels; ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    level.blurred.data = level.blurred_pixels = blurred_store_.data() + offset;
    if (i > 0) {
      level.grey.data = level.grey_pixels = grey_store_.data() + offset;
      const ImageView<std::uint8_t>& from = levels_[static_cast<std::size_t>(i - 1)].grey;
      level.row_taps = taps(from.height, level.grey.height);
      level.column_taps = group(taps(from.width, level.grey.width), from.width);
    }
    offset += level.grey.height * stride_;
  }
}

std::vector<GreyPyramid::Tap> GreyPyramid::taps(int from, int to) {
  std::vector<Tap> result;
  const double ratio = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    // Pixel centres are at integers, so images are aligned by their edges: half a pixel before the first
    // centre.
    const double at = (i + 0.5) * ratio - 0.5;
    const int first = std::clamp(static_cast<int>(std::floor(at)), 0, from - 2);
    const int weight = static_cast<int>(std::lround((at - first) * 128));
    result.push_back({first, std::clamp(weight, 0, 128)});
  }
  return result;
}

std::vector<GreyPyramid::TapGroup> GreyPyramid::group(const std::vector<Tap>& taps, int from) {
  std::vector<TapGroup> groups;
  for (std::size_t i = 0; i < taps.size(); i += lanes) {
    TapGroup g{};
    g.base = std::min(taps[i].first, from - 16);
    for (std::size_t k = 0; k < lanes; ++k) {
      const Tap& tap = taps[std::min(i + k, taps.size() - 1)];
      const int left = tap.first - g.base;
      VSG_INVARIANT(left >= 0 && left <= 14);
      g.pick[k] = static_cast<std::uint8_t>(left);
      g.pick[k + lanes] = static_cast<std::uint8_t>(left + 1);
      g.weights[k] = static_cast<std::uint16_t>(128 - tap.weight);
      g.weights[k + lanes] = static_cast<std::uint16_t>(tap.weight);
    }
    groups.push_back(g);
  }
  return groups;
}

void GreyPyramid::build(const ImageView<std::uint8_t>& grey) {
  VSG_INVARIANT(grey.width == level(0).width && grey.height == level(0).height);
  levels_[0].grey = grey;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    if (i > 0) shrink(levels_[i - 1].grey, levels_[i]);
    blur(levels_[i]);
  }
}

void GreyPyramid::shrink(const ImageView<std::uint8_t>& from, const Level& to) {
  using namespace simd;
  for (int v = 0; v < to.grey.height; ++v) {
    const Tap tap = to.row_taps[static_cast<std::size_t>(v)];
    mix(from.row(tap.first), from.row(tap.first + 1), tap.weight, from.width, row_.data());
    std::uint8_t* out = to.grey_pixels + v * stride_;
    for (const TapGroup& g : to.column_taps) {
      const U8x16 picked = __builtin_shuffle(load<U8x16>(row_.data() + g.base), load<U8x16>(g.pick));
      const U16x8 left =
          __builtin_convertvector(__builtin_shufflevector(picked, picked, 0, 1, 2, 3, 4, 5, 6, 7), U16x8);
      const U16x8 right = __builtin_convertvector(
          __builtin_shufflevector(picked, picked, 8, 9, 10, 11, 12, 13, 14, 15), U16x8);
      const U16x8 sum = left * load<U16x8>(g.weights) + right * load<U16x8>(g.weights + lanes) + 64;
      const U16x8 shifted = sum >> 7;
      const auto bytes = __builtin_convertvector(shifted, std::uint8_t __attribute__((vector_size(8))));
      store(out, bytes);
      out += lanes;
    }
  }
}

// Triangle kernel (1 2 3 4 3 2 1)/16 both ways: the weights are chosen so that 16 bits hold the exact sums.
void GreyPyramid::blur(const Level& level) {
  const ImageView<std::uint8_t>& grey = level.grey;
  const int last = grey.height - 1;
  for (int v = 0; v < grey.height; ++v) {
    const std::uint8_t* rows[7];
    for (int k = -blur_reach; k <= blur_reach; ++k)
      rows[k + blur_reach] = grey.row(std::clamp(v + k, 0, last));
    std::uint16_t* sums = sums_.data() + blur_reach;
    sum_rows(rows, grey.width, sums);
    for (int k = 1; k <= blur_reach; ++k) {
      sums[-k] = sums[0];
      sums[grey.width - 1 + k] = sums[grey.width - 1];
    }
    sum_columns(sums_.data(), grey.width, level.blurred_pixels + v * stride_);
  }
}

}  // namespace vsgraphs
