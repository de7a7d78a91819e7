// A map and frames for it, exact: features at the pixels where points of known place appear, surfaces of a room made of
// planes. Points and room need not have to do with one another.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/loops/test_loop_room.h"
#include "core/map/test_map.h"
#include "core/tracking/frame_step.h"

namespace vsgraphs::test {

inline constexpr double tracking_frame_s = 1.0 / 30.0;

class TrackingWorld {
 public:
  // Sees `seen` (point i looks like `first_name + i`) from a pose, in a room.
  FrameState frame(const Se3& world_from_camera, const Points& seen, const std::vector<Wall>& room,
                   int first_name = 0) {
    FrameState state;
    state.index = next_frame_++;
    state.timestamp_s = tracking_frame_s * static_cast<double>(state.index);
    state.features = keyframe_seeing(camera, world_from_camera, seen, first_name).features;
    state.surface = std::make_shared<const DepthGrid>(grid_of(camera, world_from_camera, room));
    state.landmarks.resize(seen.size());
    return state;
  }
  // The frame becomes a keyframe, which observes nothing yet.
  KeyframeId keep(const FrameState& state, const Se3& world_from_camera) {
    Keyframe keyframe;
    keyframe.frame_index = state.index;
    keyframe.world_from_camera = world_from_camera;
    keyframe.features = state.features;
    keyframe.surface = state.surface;
    return add_keyframe(map, keyframe);
  }
  // From now on `state` is the last frame; it hangs on `anchor`.
  void follow(FrameState state, const Se3& world_from_camera, KeyframeId anchor) {
    state.pose = {anchor, map.keyframes().find(anchor)->world_from_camera.inverse() * world_from_camera};
    last.set(std::move(state));
  }
  // Half the surface, in stripes, stands 0.3 m further away.
  static void spoil(FrameState& state) {
    DepthGrid grid = *state.surface;
    for (std::size_t i = 0; i < grid.samples.size(); ++i) {
      SurfaceSample& sample = grid.samples[i];
      if (i % 8 < 4 && sample.point.z() > 0) sample.point *= 1 + 0.3F / sample.point.z();
    }
    state.surface = std::make_shared<const DepthGrid>(std::move(grid));
  }
  KnownMaps known() { return {{map.snapshot(), nullptr}, {}}; }
  // To `now`, a thirtieth of a second later.
  FrameStep step(const FrameState& now, const Se3& predicted, const TrackerOptions& options = {}) {
    known_ = known();
    last.find_in(known_);
    const MotionGate gate(options, last.world_from_camera(), tracking_frame_s, predicted);
    return {*known_.active.map, last, now, tracking_frame_s, predicted, gate};
  }
  // One match per landmark: point i of the frame is landmark i.
  static FrameMatches matches(const FrameState& now, const std::vector<LandmarkId>& landmarks,
                              const Points& points) {
    FrameMatches all;
    all.reset(now.features->size());
    for (std::size_t i = 0; i < landmarks.size(); ++i)
      all.add({static_cast<int>(i), landmarks[i], points[i]});
    return all;
  }

  Camera camera;
  ScalePyramid pyramid;
  Map map;
  LastFrame last;

 private:
  std::int64_t next_frame_ = 0;
  KnownMaps known_;
};

inline double way_m(const Se3& a, const Se3& b) { return (a.translation() - b.translation()).norm(); }
inline double turn_rad(const Se3& a, const Se3& b) {
  return rotation_angle(a.rotation().transpose() * b.rotation());
}

}  // namespace vsgraphs::test
