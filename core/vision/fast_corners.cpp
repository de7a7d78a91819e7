#include "core/vision/fast_corners.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/base/check.h"
#include "core/vision/simd.h"

namespace vsgraphs {
namespace {

using namespace simd;

constexpr int block = 32;

// The Bresenham circle of radius 3, clockwise from the top.
constexpr std::array<std::array<int, 2>, 16> circle{{{0, -3},
                                                     {1, -3},
                                                     {2, -2},
                                                     {3, -1},
                                                     {3, 0},
                                                     {3, 1},
                                                     {2, 2},
                                                     {1, 3},
                                                     {0, 3},
                                                     {-1, 3},
                                                     {-2, 2},
                                                     {-3, 1},
                                                     {-3, 0},
                                                     {-3, -1},
                                                     {-2, -2},
                                                     {-1, -3}}};

// Largest over the 16 arcs of the smallest of nine neighbours. The arcs from k and from k+1 share eight
// values, so both are covered by min(shared, max(first, last)).
inline U8x32 best_arc(const U8x32 (&d)[16]) {
  U8x32 pairs[8], fours[8];
  for (int k = 0; k < 8; ++k) pairs[k] = min(d[2 * k + 1], d[(2 * k + 2) & 15]);
  for (int k = 0; k < 8; ++k) fours[k] = min(pairs[k], pairs[(k + 1) & 7]);
  U8x32 best{};
  for (int k = 0; k < 8; ++k) {
    const U8x32 eight = min(fours[k], fours[(k + 2) & 7]);
    best = max(best, min(eight, max(d[2 * k], d[(2 * k + 9) & 15])));
  }
  return best;
}

struct Circle {
  std::ptrdiff_t offset[16];
  explicit Circle(std::ptrdiff_t stride) {
    for (std::size_t k = 0; k < 16; ++k) offset[k] = circle[k][1] * stride + circle[k][0];
  }
};

// No arc of nine misses both ends of a diameter, so two diameters bound the score from above.
inline bool may_hold_corner(const std::uint8_t* p, const Circle& c, U8x32 threshold, int first, int second) {
  const U8x32 centre = load<U8x32>(p);
  const U8x32 a = load<U8x32>(p + c.offset[first]), b = load<U8x32>(p + c.offset[first + 8]);
  const U8x32 e = load<U8x32>(p + c.offset[second]), f = load<U8x32>(p + c.offset[second + 8]);
  const U8x32 bright = minus_saturated(min(max(a, b), max(e, f)), centre);
  const U8x32 dark = minus_saturated(centre, max(min(a, b), min(e, f)));
  return any(minus_saturated(max(bright, dark), threshold));
}

inline U8x32 scores_of(const std::uint8_t* p, const Circle& c, U8x32 threshold) {
  const U8x32 centre = load<U8x32>(p);
  U8x32 difference[16];
  for (int k = 0; k < 16; ++k) difference[k] = minus_saturated(load<U8x32>(p + c.offset[k]), centre);
  const U8x32 bright = best_arc(difference);
  for (int k = 0; k < 16; ++k) difference[k] = minus_saturated(centre, load<U8x32>(p + c.offset[k]));
  const U8x32 best = max(bright, best_arc(difference));
  return best > threshold ? best : U8x32{};
}

// Appends the peaks among 32 pixels. Of equal neighbours the first in reading order wins.
inline void append_peaks(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                         int x, int y, int from_x, std::vector<Corner>& out) {
  const U8x32 s = load<U8x32>(here + x);
  if (!any(s)) return;
  const U8x32 before = max(max(load<U8x32>(above + x - 1), load<U8x32>(above + x)),
                           max(load<U8x32>(above + x + 1), load<U8x32>(here + x - 1)));
  const U8x32 after = max(max(load<U8x32>(below + x - 1), load<U8x32>(below + x)),
                          max(load<U8x32>(below + x + 1), load<U8x32>(here + x + 1)));
  const U8x32 peaks = (s > before) & (s >= after) ? s : U8x32{};
  const U64x4 words = reinterpret_cast<U64x4>(peaks);
  for (int w = 0; w < 4; ++w) {
    for (std::uint64_t rest = words[w]; rest != 0;) {
      const int byte = std::countr_zero(rest) / 8;
      const int at = x + 8 * w + byte;
      const auto score = static_cast<std::uint8_t>(words[w] >> (8 * byte));
      if (at >= from_x) out.push_back({static_cast<std::int16_t>(at), static_cast<std::int16_t>(y), score});
      rest &= ~(std::uint64_t{0xff} << (8 * byte));
    }
  }
}

// Peak of the parabola through three values, at most half a step from the middle one. At the rim of the searched
// area the middle one need not be the largest: then there is no peak to speak of.
float parabola_peak(int before, int here, int after) {
  const int bend = 2 * here - before - after;
  return bend > 0 && here >= before && here >= after
             ? 0.5f * static_cast<float>(after - before) / static_cast<float>(bend)
             : 0.0f;
}

}  // namespace

SubpixelShift refine(const ImageView<std::uint8_t>& image, const Corner& corner) {
  // Vectors start left of the corner and reach at most 35 pixels right of it: into the next rows, which
  // exist.
  VSG_INVARIANT(corner.x >= 4 && corner.y >= 4 && corner.y + 6 < image.height && image.width > 40);
  const Circle offsets(image.stride);
  const std::uint8_t* p = image.row(corner.y) + corner.x - 1;
  const U8x32 here = scores_of(p, offsets, U8x32{});
  const U8x32 above = scores_of(p - image.stride, offsets, U8x32{});
  const U8x32 below = scores_of(p + image.stride, offsets, U8x32{});
  return {parabola_peak(here[0], here[1], here[2]), parabola_peak(above[1], here[1], below[1])};
}

void FastCorners::detect(const ImageView<std::uint8_t>& image, int threshold, int border,
                         std::vector<Corner>& out) {
  VSG_INVARIANT(border >= 4 && threshold >= 1 && threshold <= 254);
  out.clear();
  const int end_x = image.width - border, end_y = image.height - border;
  if (end_x - border < block || end_y <= border) return;
  const Circle offsets(image.stride);
  const U8x32 limit = U8x32{} + static_cast<std::uint8_t>(threshold);
  const std::size_t stride = static_cast<std::size_t>(image.width) + block;
  scores_.assign(3 * stride, 0);
  const auto row_of = [&](int y) { return scores_.data() + static_cast<std::size_t>(y % 3) * stride; };

  for (int y = border; y <= end_y; ++y) {
    std::uint8_t* scores = row_of(y);
    if (y == end_y) std::fill_n(scores, stride, std::uint8_t{0});
    for (int x = border; y < end_y && x < end_x; x += block) {
      // The last block is moved back so that it ends at the border; what it repeats comes out the same.
      const int at = std::min(x, end_x - block);
      const std::uint8_t* p = image.row(y) + at;
      const bool worth = may_hold_corner(p, offsets, limit, 0, 4) && may_hold_corner(p, offsets, limit, 2, 6);
      store(scores + at, worth ? scores_of(p, offsets, limit) : U8x32{});
    }
    if (y == border) continue;
    for (int x = border; x < end_x; x += block) {
      append_peaks(row_of(y - 2), row_of(y - 1), scores, std::min(x, end_x - block), y - 1, x, out);
    }
  }
}

}  // namespace vsgraphs
