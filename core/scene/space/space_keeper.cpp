#include "core/scene/space/space_keeper.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/map/levelling.h"

namespace vsgraphs {

// A view that is to be carved again.
struct SpaceKeeper::Moved {
  double by = 0;
  KeyframeId stretch;
  KeyframePose to;
};

void SpaceKeeper::catch_up(const Map& map, bool all) {
  work_ = {};
  if (!map.up_in_world()) return;
  const Se3 level_from_world = levelling(map);
  find_new(map);
  forget_replaced();
  put_in_place(map, level_from_world, all);
  carve_new(map, level_from_world);
  let_go(map);
  sum();
}

bool SpaceKeeper::knows(KeyframeId keyframe) const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const auto& part) { return part.second.space->views().contains(keyframe); });
}

void SpaceKeeper::find_new(const Map& map) {
  if (!std::exchange(look_for_new_, false)) return;
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) {
    if (!knows(id)) new_.insert(id);
  });
}

FreeSpace& SpaceKeeper::grid_of(Part& part) {
  ++work_.carved;
  part.summed = false;
  FreeSpace& grid = part.space.edit();
  grid.use(options_);
  return grid;
}

void SpaceKeeper::forget_replaced() {
  for (const KeyframeId id : std::exchange(replaced_, {})) {
    for (auto& [stretch, part] : parts_) {
      if (!part.space->views().contains(id)) continue;
      grid_of(part).remove(id);
    }
  }
}

bool SpaceKeeper::is_noted(KeyframeId stretch, const Part& part) const {
  return all_moved_ || moved_.contains(stretch) ||
         std::any_of(part.held_by.begin(), part.held_by.end(),
                     [this](KeyframeId holder) { return moved_.contains(holder); });
}

std::vector<CarvedView> SpaceKeeper::look_at(const Map& map, const Se3& level_from_world, Part& part) {
  std::vector<CarvedView> views;
  part.held_by.clear();
  for (const auto& [id, view] : part.space->views()) {
    CarvedView& seen = views.emplace_back(
        CarvedView{view.level_from_camera, part.level_from_grid * view.level_from_camera, !view.depth});
    const auto held = map.reanchor({id, Se3{}});
    if (!held) continue;
    part.held_by.insert(map.stretch_of(held->keyframe));
    seen.level_from_camera = level_from_world * (map.keyframes().find(held->keyframe)->world_from_camera *
                                                 held->keyframe_from_camera);
  }
  work_.checked += static_cast<int>(views.size());
  return views;
}

void SpaceKeeper::put_in_place(const Map& map, const Se3& level_from_world, bool all) {
  std::vector<Moved> moved;
  for (auto& [stretch, part] : parts_) {
    if (!is_noted(stretch, part)) continue;
    part.to_let_go = true;
    const std::vector<CarvedView> views = look_at(map, level_from_world, part);
    const Se3 before = part.level_from_grid;
    part.level_from_grid = placement_of(views, before, max_reintegrations_, options_);
    const bool stays = part.level_from_grid.matrix() == before.matrix();
    part.summed = part.summed && stays;
    const Se3 grid_from_level = part.level_from_grid.inverse();
    std::size_t i = 0;
    for (const auto& [id, view] : part.space->views()) {
      const CarvedView& seen = views[i++];
      const Se3 to = grid_from_level * seen.level_from_camera;
      const double by = off_by(seen.grid_from_camera, to, options_);
      if (by > 1 && !seen.frozen) moved.push_back({by, stretch, {id, to}});
    }
  }
  std::sort(moved.begin(), moved.end(), [](const Moved& a, const Moved& b) {
    return a.by != b.by ? a.by > b.by : a.to.keyframe < b.to.keyframe;
  });
  all_moved_ = false;
  moved_.clear();
  int left = all ? std::numeric_limits<int>::max() : max_reintegrations_;
  for (const Moved& view : moved) {
    if (left-- <= 0) {
      moved_.insert(view.stretch);
      continue;
    }
    grid_of(parts_.at(view.stretch)).refresh({&view.to, 1}, 1);
  }
}

bool SpaceKeeper::is_full() const {
  std::size_t blocks = 0;
  for (const auto& [stretch, part] : parts_) blocks += part.space->voxels().blocks().size();
  return blocks >= static_cast<std::size_t>(options_.max_blocks);
}

void SpaceKeeper::carve_new(const Map& map, const Se3& level_from_world) {
  for (const KeyframeId id : std::exchange(new_, {})) {
    const Keyframe* keyframe = map.keyframes().find(id);
    if (!keyframe || !keyframe->surface) continue;
    if (is_full()) {
      ++refused_;
      continue;
    }
    const auto [at, begun] = parts_.try_emplace(keyframe->stretch);
    Part& part = at->second;
    if (begun) part.space = CopyOnWrite(FreeSpace(options_));
    grid_of(part).integrate(
        id, keyframe->surface,
        part.level_from_grid.inverse() * (level_from_world * keyframe->world_from_camera));
    part.held_by.insert(keyframe->stretch);
  }
}

void SpaceKeeper::sum() {
  std::vector<BlockKey> changed = std::exchange(left_, {});
  for (auto& [stretch, part] : parts_) {
    if (part.summed) continue;
    const auto& blocks = part.space->voxels().blocks();
    if (std::any_of(blocks.begin(), blocks.end(), [](const auto& block) { return block.empty(); }))
      part.space.edit().drop_empty();
    changed.insert(changed.end(), part.covers.begin(), part.covers.end());
    part.covers = covered_blocks(part.space->voxels(), part.level_from_grid, options_.voxel_m);
    changed.insert(changed.end(), part.covers.begin(), part.covers.end());
    part.summed = true;
  }
  std::erase_if(parts_, [](const auto& part) { return part.second.space->views().empty(); });
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  bool emptied = false;
  for (const BlockKey key : changed) {
    VoxelBlocks::Block block;
    block.origin = origin_of(key);
    for (const auto& [stretch, part] : parts_) {
      if (std::binary_search(part.covers.begin(), part.covers.end(), key))
        add_placed(part.space->voxels(), part.level_from_grid, options_.voxel_m, block);
    }
    const bool empty = block.empty();
    const bool known = whole_->find(block.origin) != nullptr;
    emptied |= empty && known;
    if (!empty || known) whole_.edit().block(block.origin) = block;
  }
  if (emptied) whole_.edit().drop_empty();
  work_.summed = static_cast<int>(changed.size());
}

}  // namespace vsgraphs
