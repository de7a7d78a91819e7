// The bookkeeping of a nearest-neighbour search, shared by the matchers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/vision/matching.h"

namespace vsgraphs {

// A distance and an index (below 65536) in one number: the smaller is the better and ties go to the lower
// index.
using MatchKey = std::uint32_t;
inline constexpr MatchKey no_key = std::numeric_limits<MatchKey>::max();
inline constexpr int no_distance = 257;

constexpr MatchKey make_key(int distance, std::size_t index) {
  return static_cast<MatchKey>(distance) << 16 | static_cast<MatchKey>(index);
}
constexpr int distance_of(MatchKey key) { return key == no_key ? no_distance : static_cast<int>(key >> 16); }
constexpr int index_of(MatchKey key) { return static_cast<int>(key & 0xffffu); }

struct BestTwo {
  MatchKey best = no_key, second = no_key;
  void add(MatchKey key) {
    second = std::min(second, std::max(best, key));
    best = std::min(best, key);
  }
};

inline bool distinct(int best, int second, const MatchOptions& options) {
  return best <= options.max_distance && (options.ratio >= 1 || best < options.ratio * second);
}

}  // namespace vsgraphs
