// A true set of matches turns alike: pairs whose change of orientation few others share are mostly wrong.
#pragma once

#include <span>
#include <vector>

namespace vsgraphs {

// Per difference of orientation (rad, any range) whether it lies in one of the three fullest of 30 bins; the
// second and third count only when they hold at least a tenth of the first.
std::vector<bool> consistent_rotation(std::span<const float> differences_rad);

}  // namespace vsgraphs
