// What the keeper of free space takes note of while edits go by, and when it lets go of what it no longer needs.
#include <variant>

#include "core/scene/space/space_keeper.h"

namespace vsgraphs {

void SpaceKeeper::follow(const Map& /*before*/, const MapEdit& edit, const Map& after,
                         const Follower* absorbed) {
  for (const EditOperation& operation : edit.operations) {
    if (const auto* add = std::get_if<AddKeyframe>(&operation)) {
      new_.insert(add->id);
    } else if (const auto* move = std::get_if<MoveKeyframe>(&operation)) {
      moved_.insert(after.stretch_of(move->id));
    } else if (const auto* remove = std::get_if<RemoveKeyframe>(&operation)) {
      if (remove->replaced) replaced_.insert(remove->id);
      moved_.insert(after.stretch_of(remove->id));
    } else if (std::holds_alternative<SetUp>(operation)) {
      all_moved_ = true;
    } else if (const auto* absorb = std::get_if<AbsorbMap>(&operation)) {
      take_over(*absorb->other, dynamic_cast<const SpaceKeeper*>(absorbed));
    }
  }
}

void SpaceKeeper::take_over(const Map& other, const SpaceKeeper* absorbed) {
  const bool usable = absorbed && absorbed->options_.voxel_m == options_.voxel_m &&
                      absorbed->options_.range_m == options_.range_m;
  if (!usable || absorbed->look_for_new_) {
    other.keyframes().for_each([&](KeyframeId id, const Keyframe&) {
      if (!usable || !absorbed->knows(id)) new_.insert(id);
    });
  }
  if (!usable) return;
  for (const auto& [stretch, part] : absorbed->parts_) {
    const auto [at, added] = parts_.emplace(stretch, part);
    if (!added) continue;
    at->second.summed = false;
    at->second.covers.clear();
    moved_.insert(stretch);
  }
  new_.insert(absorbed->new_.begin(), absorbed->new_.end());
  replaced_.insert(absorbed->replaced_.begin(), absorbed->replaced_.end());
  refused_ += absorbed->refused_;
}

void SpaceKeeper::clear() {
  for (const auto& [stretch, part] : parts_)
    left_.insert(left_.end(), part.covers.begin(), part.covers.end());
  parts_.clear();
  new_.clear();
  replaced_.clear();
  moved_.clear();
  all_moved_ = false;
  look_for_new_ = true;
  refused_ = 0;
}

void SpaceKeeper::gather(const Map& /*map*/) { clear(); }

bool SpaceKeeper::adopt(const Follower& known) {
  const FreeSpaceOptions options = options_;
  const int max_reintegrations = max_reintegrations_;
  *this = dynamic_cast<const SpaceKeeper&>(known);
  use(options, max_reintegrations);
  return true;
}

void SpaceKeeper::use(const FreeSpaceOptions& options, int max_reintegrations) {
  const bool same = options.voxel_m == options_.voxel_m && options.range_m == options_.range_m;
  options_ = options;
  max_reintegrations_ = max_reintegrations;
  if (!same) clear();
}

// A keyframe that is gone is not corrected by itself any more once the map goes on elsewhere, and its depth is held by nobody else.
void SpaceKeeper::let_go(const Map& map) {
  const KeyframeId newest_stretch = map.stretch_of(map.keyframes().last());
  for (auto& [stretch, part] : parts_) {
    if (!part.to_let_go || moved_.contains(stretch)) continue;
    part.to_let_go = false;
    std::vector<KeyframeId> gone;
    for (const auto& [id, view] : part.space->views()) {
      if (!view.depth || map.keyframes().contains(id)) continue;
      if (map.stretch_of(id) == newest_stretch)
        part.to_let_go = true;
      else
        gone.push_back(id);
    }
    for (const KeyframeId id : gone) part.space.edit().freeze(id);
  }
}

SpaceView SpaceKeeper::view() const {
  std::map<KeyframeId, FreeSpace::View> views;
  for (const auto& [stretch, part] : parts_)
    for (const auto& [id, view] : part.space->views())
      views[id] = {view.depth, part.level_from_grid * view.level_from_camera};
  std::vector<FreeSpace::View> ordered;
  ordered.reserve(views.size());
  for (auto& [id, view] : views) ordered.push_back(std::move(view));
  return {*whole_, options_.voxel_m, std::move(ordered)};
}

std::size_t SpaceKeeper::memory_bytes() const {
  std::size_t bytes = whole_->memory_bytes();
  for (const auto& [stretch, part] : parts_)
    bytes += part.space->memory_bytes() + part.covers.capacity() * sizeof(BlockKey);
  return bytes;
}

std::string SpaceKeeper::warning() const {
  if (refused_ == 0) return {};
  return "rooms are sought without " + std::to_string(refused_) +
         " keyframes: free space has grown beyond structure.free_space.max_blocks (" +
         std::to_string(options_.max_blocks) + ")";
}

}  // namespace vsgraphs
