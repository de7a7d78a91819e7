// Tracking: one frame in, its pose out. Reads snapshots of the maps, writes nothing.
//
// The frame's way (Tracker::track), each step a class of its own:
//   extract     FrameExtractor     ORB features with depth, samples of the surfaces
//   predict     LastFrame          where the last frame stands in the maps as they are now
//               MotionModel        constant velocity from there
//   match       LastFrameMatcher   the last frame's points around the prediction, or by descriptors (Recovery)
//   and solve   LocalMapMatcher    the landmarks around, and the pose with all of them
//   judge       PoseVerifier       by surfaces, by walls looked through, by how far it can have moved (MotionGate)
//   or hold     SurfaceTracker     by surfaces where landmarks are few
//   answer      frame_anchor.h     the keyframe it hangs on
//               KeyframeSelector   whether it should become one, with what LandmarkSightings counted
// Where all that fails, the pose is coasted for a moment and then lost (LossTimer) until a keyframe is recognised
// (Relocaliser) or a new map is started.
// Scheme after ORB-SLAM2 (Mur-Artal, Tardos, T-RO 2017); residuals, gates and recovery are our own (docs).
#pragma once

#include <optional>

#include "core/base/trace.h"
#include "core/matching/messages.h"
#include "core/tracking/frame_extractor.h"
#include "core/tracking/keyframe_selector.h"
#include "core/tracking/landmark_sightings.h"
#include "core/tracking/last_frame.h"
#include "core/tracking/last_frame_matcher.h"
#include "core/tracking/local_map_matcher.h"
#include "core/tracking/loss_timer.h"
#include "core/tracking/motion_model.h"
#include "core/tracking/pose_verifier.h"
#include "core/tracking/relocaliser.h"
#include "core/tracking/surface_tracker.h"
#include "core/tracking/tracker_options.h"

namespace vsgraphs {

class Tracker {
 public:
  Tracker(const TrackerOptions& options, const OrbOptions& orb, const Camera& camera, std::uint64_t seed);
  Tracker(const Tracker&) = delete;  // its parts know one another
  Tracker& operator=(const Tracker&) = delete;

  // `backlog`: keyframes requested earlier and not yet in the maps. Frames come with increasing timestamps; after a frame
  // that started a map, its keyframe is in the active one. Begins lost where maps are known from the start. A frame found
  // again in a dormant map asks for a keyframe there: whoever makes it makes that map the active one.
  // Throws InputError for images that do not fit the camera.
  TrackedFrame track(const RgbdFrame& frame, const KnownMaps& known, int backlog, TraceSink* trace);

 private:
  FrameState extract(const RgbdFrame& frame, TraceSink* trace);
  bool enough_to_start(const FrameState& now) const;
  const KnownMap* place_last_frame(const KnownMaps& known);
  FrameStep step_to(const FrameState& now, const Map& map) const;
  std::optional<MatchedPose> follow(const FrameStep& step, TraceSink* trace);
  std::optional<Relocalisation> relocalise(const KnownMaps& known, const KnownMap* last_in,
                                           const FrameState& now, TraceSink* trace);

  // Each ends a frame's way.
  TrackedFrame start(FrameState& now);
  TrackedFrame go_on(const FrameStep& step, const MatchedPose& found, FrameState& now, int backlog);
  TrackedFrame resume(const Map& map, const MatchedPose& found, bool dormant, FrameState& now, int backlog);
  TrackedFrame coast(const FrameStep& step, FrameState& now) const;
  TrackedFrame stay_lost(FrameState& now);

  void anchor(const Map& map, const MatchedPose& found, KeyframeId near, FrameState& now);
  TrackedFrame answer(const Map& map, const MatchedPose& found, TrackStatus status, bool always_keep,
                      FrameState& now, int backlog);

  TrackerOptions options_;
  ScalePyramid pyramid_;
  DepthAligner aligner_;
  Recovery recovery_;

  FrameExtractor extractor_;
  LastFrame last_;
  MotionModel motion_;
  LastFrameMatcher last_frame_matcher_;
  LocalMapMatcher local_map_matcher_;
  PoseVerifier verifier_;
  SurfaceTracker surfaces_;
  Relocaliser relocaliser_;
  LossTimer loss_;
  LandmarkSightings sightings_;
  KeyframeSelector keyframes_;
};

}  // namespace vsgraphs
