#include "core/vision/spread.h"

#include <algorithm>
#include <cmath>

namespace vsgraphs {
namespace {

// Corners a cell gives when all are full. One per cell spreads best but takes corners that are not found
// again; five give 10 % more matches between views and the most certain pose of 1, 3, 5, 8, 16 and 40.
constexpr double corners_per_cell = 5;

}  // namespace

void CornerSpread::rank_cells(const std::vector<Corner>& corners, int width, int height, int wanted,
                              int strong) {
  constexpr double smallest_cell_px = 8;
  const double area = static_cast<double>(width) * height;
  const double cell_px = std::max(smallest_cell_px, std::sqrt(area * corners_per_cell / wanted));
  const int columns = static_cast<int>(width / cell_px) + 1, rows = static_cast<int>(height / cell_px) + 1;
  const float per_px = static_cast<float>(1.0 / cell_px);

  // Counting sort by cell; a cell's corners stay in reading order.
  cell_begin_.assign(static_cast<std::size_t>(columns) * rows + 1, 0);
  cell_of_.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int column = static_cast<int>(static_cast<float>(corners[i].x) * per_px);
    const int row = static_cast<int>(static_cast<float>(corners[i].y) * per_px);
    cell_of_[i] = static_cast<std::uint16_t>(row * columns + column);
    ++cell_begin_[cell_of_[i] + 1u];
  }
  for (std::size_t c = 1; c < cell_begin_.size(); ++c) cell_begin_[c] += cell_begin_[c - 1];
  keys_.resize(corners.size());
  for (std::size_t i = corners.size(); i-- > 0;) {
    // Sorting keys ascending puts high scores first and, among equals, reading order.
    keys_[--cell_begin_[cell_of_[i] + 1u]] = (255u - corners[i].score) << 24 | static_cast<std::uint32_t>(i);
  }
  // The loop above moved each begin one cell down: cell_begin_[c + 1] is now where cell c starts.
  ranked_.clear();
  per_rank_.clear();
  for (std::size_t c = 0; c + 1 < cell_begin_.size(); ++c) {
    const std::uint32_t begin = cell_begin_[c + 1];
    const std::uint32_t end =
        c + 2 < cell_begin_.size() ? cell_begin_[c + 2] : static_cast<std::uint32_t>(keys_.size());
    if (begin == end) continue;
    std::sort(keys_.begin() + begin, keys_.begin() + end);
    const bool has_strong = static_cast<int>(255 - (keys_[begin] >> 24)) >= strong;
    for (std::uint32_t k = begin; k < end; ++k) {
      const Corner& corner = corners[keys_[k] & 0xffffffu];
      if (has_strong && corner.score < strong) break;
      const std::uint32_t rank = k - begin;
      ranked_.push_back({corner, static_cast<std::uint16_t>(rank)});
      if (rank >= per_rank_.size()) per_rank_.push_back(0);
      ++per_rank_[rank];
    }
  }
}

void CornerSpread::choose(const std::vector<Corner>& corners, int width, int height, int wanted, int strong,
                          std::vector<ChosenCorner>& out) {
  out.clear();
  if (wanted <= 0 || corners.empty()) return;
  rank_cells(corners, width, height, wanted, strong);

  int room = wanted;
  std::size_t last = 0;  // the round that does not fit as a whole
  while (last < per_rank_.size() && per_rank_[last] <= room) room -= per_rank_[last++];
  last_round_.clear();
  for (std::size_t i = 0; i < ranked_.size(); ++i) {
    if (ranked_[i].rank < last) out.push_back(ranked_[i]);
    if (ranked_[i].rank == last)
      last_round_.push_back((255u - ranked_[i].corner.score) << 24 | static_cast<std::uint32_t>(i));
  }
  if (last_round_.empty()) return;
  std::sort(last_round_.begin(), last_round_.end());
  for (int k = 0; k < room; ++k) out.push_back(ranked_[last_round_[static_cast<std::size_t>(k)] & 0xffffffu]);
}

}  // namespace vsgraphs
