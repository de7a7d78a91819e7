#include "core/vision/rotation_vote.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vsgraphs {
namespace {

constexpr int bins = 30;

int bin_of(float difference_rad) {
  const double turns = difference_rad / (2 * std::numbers::pi);
  return static_cast<int>(std::lround((turns - std::floor(turns)) * bins)) % bins;
}

}  // namespace

std::vector<bool> consistent_rotation(std::span<const float> differences_rad) {
  std::array<int, bins> votes{}, order{};
  for (float d : differences_rad) ++votes[static_cast<std::size_t>(bin_of(d))];
  for (int i = 0; i < bins; ++i) order[static_cast<std::size_t>(i)] = i;
  const auto votes_of = [&](int bin) { return votes[static_cast<std::size_t>(bin)]; };
  std::stable_sort(order.begin(), order.end(), [&](int x, int y) { return votes_of(x) > votes_of(y); });

  std::array<bool, bins> kept{};
  for (std::size_t i = 0; i < 3; ++i) {
    kept[static_cast<std::size_t>(order[i])] = i == 0 || 10 * votes_of(order[i]) >= votes_of(order[0]);
  }
  std::vector<bool> result;
  result.reserve(differences_rad.size());
  for (float d : differences_rad) result.push_back(kept[static_cast<std::size_t>(bin_of(d))]);
  return result;
}

}  // namespace vsgraphs
