// Which frames are asked to become keyframes: gathers what keyframe_policy.h decides by, and writes the request.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/map/map.h"
#include "core/matching/messages.h"
#include "core/tracking/frame_state.h"
#include "core/tracking/keyframe_policy.h"

namespace vsgraphs {

class KeyframeSelector {
 public:
  explicit KeyframeSelector(const KeyframePolicyOptions& options) : options_(options) {}

  // `now` hangs on a keyframe of `map`; `backlog`: keyframes requested and not yet in the map. Linear in the features and in
  // the landmarks of that keyframe.
  bool wanted(const Map& map, const FrameState& now, const Se3& world_from_camera, int backlog) const;

  // The request for a frame, which is the last keyframe from now on. `first`: it starts a map.
  std::shared_ptr<const KeyframeRequest> request(const FrameState& now, bool first,
                                                 std::vector<Sighting> sightings);

  // The keyframe that a request which started a map became; nothing where the last request names one already.
  void name_first(KeyframeId id);

 private:
  KeyframeEvidence gather(const Map& map, const FrameState& now, const Se3& world_from_camera,
                          int backlog) const;

  KeyframePolicyOptions options_;
  std::optional<AnchoredPose> last_pose_;  // of the last request
  double last_s_ = 0;
};

}  // namespace vsgraphs
