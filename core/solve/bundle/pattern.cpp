#include "core/solve/bundle/pattern.h"

#include <algorithm>

namespace vsgraphs {

void build_pattern(const VariableOrder& order, const DensePart& dense, LandmarkPart& landmarks,
                   BlockMatrix& pattern) {
  std::vector<std::vector<int>> rows(order.dims.size());
  for (std::size_t v = 0; v < rows.size(); ++v) rows[v].push_back(static_cast<int>(v));
  landmarks.add_pairs(rows);
  dense.add_pairs(rows);
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  pattern.build(order.dims, rows);
  landmarks.bind(pattern);
}

}  // namespace vsgraphs
