#include "core/map/label_grid.h"

#include <algorithm>
#include <cmath>

namespace vsgraphs {

bool fits_together(const ClassGrid& grid) {
  if (grid.columns < 0 || grid.rows < 0 || grid.columns > 65535 || grid.rows > 65535) return false;
  const auto size = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  const auto out_of_order = [](ClassId a, ClassId b) { return !(a < b); };
  return grid.which.size() == size && grid.confidences.size() == size && grid.instances.size() == size &&
         (grid.classes.empty() || !grid.classes.front().none()) &&
         std::adjacent_find(grid.classes.begin(), grid.classes.end(), out_of_order) == grid.classes.end() &&
         std::all_of(grid.which.begin(), grid.which.end(),
                     [&](std::uint16_t k) { return k <= grid.classes.size(); });
}

std::shared_ptr<const ClassGrid> classes_of(const LabelGrid& labels) {
  ClassGrid grid;
  grid.columns = labels.columns;
  grid.rows = labels.rows;
  for (const auto& [id, name] : labels.class_names) grid.classes.push_back(id);
  if (grid.classes.empty()) return nullptr;
  for (const LabelSample& sample : labels.samples) {
    const auto at = std::lower_bound(grid.classes.begin(), grid.classes.end(), sample.named);
    grid.which.push_back(sample.named.none() ? std::uint16_t{0}
                                             : static_cast<std::uint16_t>(at - grid.classes.begin() + 1));
    grid.confidences.push_back(static_cast<std::uint8_t>(std::lround(255 * sample.confidence)));
    grid.instances.push_back(sample.instance);
  }
  return std::make_shared<const ClassGrid>(std::move(grid));
}

}  // namespace vsgraphs
