// Chooses which corners of an image to keep: the best ones, but spread over the image, because a pose is held
// by where its features lie more than by how strong they are.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vision/fast_corners.h"

namespace vsgraphs {

struct ChosenCorner {
  Corner corner;
  std::uint16_t rank = 0;  // 0: best of its cell, 1: second best, ...
};

class CornerSpread {
 public:
  // Cuts a `width` x `height` image into about `wanted` / 5 square cells and takes the best corner of every
  // cell, then every cell's second best, and so on until `wanted` are chosen (the last round by score).
  // Corners below `strong` count only in cells without a strong one. Deterministic; `out` is replaced; order:
  // by cell.
  void choose(const std::vector<Corner>& corners, int width, int height, int wanted, int strong,
              std::vector<ChosenCorner>& out);

 private:
  void rank_cells(const std::vector<Corner>& corners, int width, int height, int wanted, int strong);

  std::vector<std::uint32_t> cell_begin_, keys_;
  std::vector<std::uint16_t> cell_of_;
  std::vector<ChosenCorner> ranked_;
  std::vector<int> per_rank_;
  std::vector<std::uint32_t> last_round_;
};

}  // namespace vsgraphs
