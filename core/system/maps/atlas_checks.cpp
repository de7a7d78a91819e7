#include "core/system/maps/atlas_checks.h"

#include <algorithm>

#include "core/base/text.h"

namespace vsgraphs {

namespace {

// One name, one thing: of a table's indices none is in use in two maps. Nor do they run far ahead of what is in use: arrays are
// as long as they say.
class Taken {
 public:
  template <typename Table>
  bool take(const Table& table) {
    constexpr std::uint64_t most_ahead = 1U << 22;
    std::uint64_t end = 0;
    bool fresh = true;
    for (std::uint32_t index = 0; index < table.index_bound(); ++index) {
      if (!table.at_index(index).valid()) continue;
      end = index + std::uint64_t{1};
      if (taken_.size() < end) taken_.resize(end);
      fresh = fresh && !taken_[index];
      taken_[index] = true;
    }
    return fresh && table.index_bound() <= end + most_ahead;
  }

 private:
  std::vector<bool> taken_;
};

bool share_ids(const AtlasState& state) {
  Taken keyframes, landmarks, planes;
  return !std::all_of(state.maps.begin(), state.maps.end(), [&](const MapState& one) {
    const bool alone = keyframes.take(one.map->retired_keyframes());
    return landmarks.take(one.map->landmarks()) && planes.take(one.map->planes()) && alone;
  });
}

// Maps may be joined, and then know the same classes.
bool name_differently(const AtlasState& state) {
  ClassNames all;
  return !std::all_of(state.maps.begin(), state.maps.end(), [&all](const MapState& one) {
    const ClassNames& names = one.map->class_names();
    return std::all_of(names.begin(), names.end(),
                       [&all](const auto& named) { return all.insert(named).first->second == named.second; });
  });
}

Wrong wrong_with(const MapState& state) {
  if (state.map->keyframes().index_bound() > PlaceSegment::most_keyframes)
    return "it numbers more keyframes than there can be";
  for (const auto& follower : state.followers.all())
    if (Wrong wrong = follower->wrong_with(*state.map)) return wrong;
  return nullptr;
}

}  // namespace

Wrong wrong_with_maps(const AtlasState& state) {
  for (const MapState& one : state.maps) {
    if (Wrong wrong = wrong_with_references(*one.map)) return wrong;
    if (Wrong wrong = wrong_with_values(*one.map)) return wrong;
  }
  return nullptr;
}

Wrong wrong_with_atlas(const SavedAtlas& atlas) {
  if (!atlas.map_names.empty() && atlas.map_names.size() != atlas.state.maps.size())
    return "maps and names differ in number";
  if (!is_text(atlas.program) || !is_text(atlas.commit) || !is_text(atlas.configuration) ||
      !std::all_of(atlas.map_names.begin(), atlas.map_names.end(), is_text))
    return "a text that is none";
  for (const MapState& state : atlas.state.maps) {
    if (Wrong wrong = wrong_with(state)) return wrong;
  }
  if (share_ids(atlas.state)) return "ids that are not its maps' own";
  if (name_differently(atlas.state)) return "two classes of one number";
  return nullptr;
}

}  // namespace vsgraphs
