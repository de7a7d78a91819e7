// The 256 comparisons a descriptor is made of.
#pragma once

#include <array>
#include <cstdint>

namespace vsgraphs {

// Bit = smoothed intensity at (x0, y0) < at (x1, y1); pixels from the patch's centre, x right, y down, within
// 14 px.
struct BriefPair {
  std::int8_t x0, y0, x1, y1;
};

// Part of the meaning of every saved descriptor: changing it makes saved maps unreadable.
extern const std::array<BriefPair, 256> brief_pattern;

}  // namespace vsgraphs
