#include "core/scene/space/space_placement.h"

#include <algorithm>

namespace vsgraphs {
namespace {

constexpr std::size_t most_candidates = 9;

struct Misfits {
  int all = 0, frozen = 0;
};

Misfits misfits(std::span<const CarvedView> views, const Se3& level_from_grid,
                const FreeSpaceOptions& options) {
  Misfits result;
  for (const CarvedView& view : views) {
    if (off_by(level_from_grid * view.grid_from_camera, view.level_from_camera, options) <= 1) continue;
    ++result.all;
    result.frozen += view.frozen ? 1 : 0;
  }
  return result;
}

}  // namespace

Se3 placement_of(std::span<const CarvedView> views, const Se3& present, int tolerated,
                 const FreeSpaceOptions& options) {
  const Misfits now = misfits(views, present, options);
  if (now.all <= tolerated && now.frozen == 0) return present;
  Se3 best = present;
  int fewest = (now.all + 1) / 2;
  const auto consider = [&](const Se3& candidate) {
    const int count = misfits(views, candidate, options).all;
    if (count >= fewest) return;
    fewest = count;
    best = candidate;
  };
  consider(Se3{});
  const std::size_t count = std::min(views.size(), most_candidates);
  for (std::size_t i = 0; i < count && fewest > 0; ++i) {
    const CarvedView& view = views[count == 1 ? 0 : i * (views.size() - 1) / (count - 1)];
    consider((view.level_from_camera * view.grid_from_camera.inverse()).normalized());
  }
  return best;
}

}  // namespace vsgraphs
