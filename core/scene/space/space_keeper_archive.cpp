// The keeper of free space in an archive: options and grids. The whole follows from them, and what waits is found by looking.
#include "core/geometry/bounds.h"
#include "core/scene/space/free_space_checks.h"
#include "core/scene/space/space_keeper.h"

namespace vsgraphs {
namespace {

// What does not hang on the map.
Wrong wrong_with_parts(const std::map<KeyframeId, SpaceKeeper::Part>& parts,
                       const FreeSpaceOptions& options) {
  if (Wrong wrong = wrong_with_free_space(FreeSpace(options))) return wrong;
  for (const auto& [stretch, part] : parts) {
    const FreeSpaceOptions& its = part.space->options();
    if (its.voxel_m != options.voxel_m || its.range_m != options.range_m)
      return "free space of several resolutions";
    if (!is_pose(part.level_from_grid)) return "free space that stands nowhere";
    if (Wrong wrong = wrong_with_free_space(*part.space)) return wrong;
  }
  return nullptr;
}

}  // namespace

void SpaceKeeper::save(ArchiveWriter& archive, const std::string& section) const {
  archive.add(section, options_, parts_);
}

void SpaceKeeper::load(const ArchiveReader& archive, const std::string& section) {
  FreeSpaceOptions options;
  std::map<KeyframeId, Part> parts;
  if (archive.version() < 3) {
    Part one;
    archive.read(section, one.space.edit());
    options = one.space->options();
    if (!one.space->views().empty()) parts.emplace(one.space->views().begin()->first, std::move(one));
  } else {
    archive.read(section, options, parts);
  }
  if (Wrong wrong = wrong_with_parts(parts, options)) archive.damaged(wrong);
  clear();
  options_ = options;
  parts_ = std::move(parts);
  all_moved_ = true;
  whole_ = {};
  left_.clear();
  sum();
}

Wrong SpaceKeeper::wrong_with(const Map& map) const {
  if (Wrong wrong = wrong_with_parts(parts_, options_)) return wrong;
  for (const auto& [stretch, part] : parts_) {
    if (!map.retired_keyframes().contains(stretch)) return "free space of a stretch that does not exist";
    for (const auto& [id, view] : part.space->views()) {
      if (!map.retired_keyframes().contains(id)) return "free space seen by a keyframe that does not exist";
    }
  }
  return nullptr;
}

}  // namespace vsgraphs
