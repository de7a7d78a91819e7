#include "core/tracking/last_frame.h"

#include <algorithm>

namespace vsgraphs {

KeyframeId LastFrame::name_own_keyframe(const Map& active) {
  if (!state_ || state_->pose.keyframe.valid()) return {};
  state_->pose.keyframe = active.keyframe_of_frame(state_->index);
  return state_->pose.keyframe;
}

const KnownMap* LastFrame::find_in(const KnownMaps& known) {
  world_from_camera_.reset();
  if (!state_) return nullptr;
  if (held_by(*known.active.map)) return &known.active;
  for (const KnownMap& dormant : known.dormant) {
    if (held_by(*dormant.map)) return &dormant;
  }
  return nullptr;
}

bool LastFrame::held_by(const Map& map) {
  const auto living = map.reanchor(state_->pose);
  if (!living) return false;
  state_->pose = *living;
  world_from_camera_ = *map.resolve(*living);
  adopt_landmarks(map);
  return true;
}

// If the frame has become a keyframe meanwhile, its features have landmarks that the frame did not know.
void LastFrame::adopt_landmarks(const Map& map) {
  const std::uint32_t bound = map.keyframes().index_bound();
  for (std::uint32_t back = 1; back <= std::min<std::uint32_t>(bound, 4); ++back) {
    const Keyframe* keyframe = map.keyframes().find(map.keyframes().at_index(bound - back));
    if (keyframe && keyframe->frame_index == state_->index) {
      state_->landmarks = keyframe->landmarks;
      return;
    }
  }
  for (LandmarkId& id : state_->landmarks) {
    if (id.valid()) id = map.landmarks().resolve(id);
  }
}

}  // namespace vsgraphs
