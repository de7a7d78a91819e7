// The last frame that had a pose, and where it stands in the maps as they are now: mapping goes on between two frames.
#pragma once

#include <optional>
#include <utility>

#include "core/matching/messages.h"
#include "core/tracking/frame_state.h"

namespace vsgraphs {

class LastFrame {
 public:
  bool exists() const { return state_.has_value(); }
  void set(FrameState state) {
    state_ = std::move(state);
    world_from_camera_.reset();
  }

  // The keyframe made of a frame that started a map had no name then: gives it the one it has in `active`, and returns that.
  // An invalid id where nothing was to be named.
  KeyframeId name_own_keyframe(const Map& active);

  // The map that holds the frame, which may have been moved or joined with another since: the active one, else a dormant one;
  // null if none does, or there is no last frame. Brings the pose's anchor and the landmarks up to that map. Linear in the
  // features.
  const KnownMap* find_in(const KnownMaps& known);

  // Of a frame that exists.
  const FrameState& state() const { return *state_; }
  // In the world of the map that find_in() found.
  const Se3& world_from_camera() const { return *world_from_camera_; }

 private:
  bool held_by(const Map& map);
  void adopt_landmarks(const Map& map);

  std::optional<FrameState> state_;
  std::optional<Se3> world_from_camera_;
};

}  // namespace vsgraphs
