// Tracking: one frame in, its pose out. Reads a snapshot, writes nothing.
//
// Per frame: ORB features with depth -> constant-velocity prediction -> search around the last frame's points ->
// pose -> search around the local map's landmarks -> pose. Where prediction fails, descriptors are matched
// without it; where that fails, the pose is coasted for a moment and then lost until a keyframe is recognised.
// A pose further away than a camera can have moved is never believed.
// Scheme after ORB-SLAM2 (Mur-Artal, Tardos, T-RO 2017); residuals, gates and recovery are our own (docs).
#pragma once

#include <functional>
#include <optional>
#include <unordered_map>

#include "core/base/options.h"
#include "core/base/trace.h"
#include "core/matching/frame_pose.h"
#include "core/matching/local_map.h"
#include "core/matching/messages.h"
#include "core/tracking/depth_alignment.h"
#include "core/tracking/keyframe_policy.h"
#include "core/tracking/motion_model.h"
#include "core/tracking/recovery.h"
#include "core/vision/orb_extractor.h"

namespace vsgraphs {

struct TrackerOptions {
  double search_radius_px = 15;
  double local_search_radius_px = 5;
  int local_keyframes = 20;
  int min_inliers = 20;
  int few_inliers = 120;
  int enough_inliers = 40;
  int min_features_to_start = 100;
  double max_speed_m_per_s = 3.0;
  double max_turn_rad_per_s = 5.0;
  double max_velocity_change_m_per_s = 1.2;
  double max_turn_change_rad_per_s = 2.5;
  double coast_s = 0.4;
  int coast_frames = 3;
  double new_map_after_s = 2.0;
  KeyframePolicyOptions keyframe;
  RecoveryOptions recovery;
};

template <typename Visitor>
void describe(TrackerOptions& o, Visitor& field) {
  field("search_radius_px", o.search_radius_px, 2.0, 200.0,
        "search around predicted points of the last frame");
  field("local_search_radius_px", o.local_search_radius_px, 1.0, 50.0, "search around projected landmarks");
  field("local_keyframes", o.local_keyframes, 2, 200, "keyframes whose landmarks a frame is matched against");
  field("min_inliers", o.min_inliers, 6, 200, "fewer inlier matches than this are no pose");
  field("few_inliers", o.few_inliers, 0, 1000,
        "with fewer inlier matches than this, depth is aligned with a keyframe's as well");
  field("enough_inliers", o.enough_inliers, 6, 1000,
        "a pose with this many inlier matches stands even where depth alignment fails or contradicts it");
  field("min_features_to_start", o.min_features_to_start, 20, 5000,
        "features with depth needed to start a map");
  field("max_speed_m_per_s", o.max_speed_m_per_s, 0.1, 100.0,
        "a pose that would need more speed is rejected");
  field("max_turn_rad_per_s", o.max_turn_rad_per_s, 0.1, 100.0,
        "a pose that would need a faster turn is rejected");
  field("max_velocity_change_m_per_s", o.max_velocity_change_m_per_s, 0.1, 100.0,
        "a pose that would need a larger change of velocity from one frame to the next is rejected");
  field("max_turn_change_rad_per_s", o.max_turn_change_rad_per_s, 0.1, 100.0,
        "a pose that would need a larger change of turn rate from one frame to the next is rejected");
  field("coast_s", o.coast_s, 0.0, 5.0, "how long the motion model is believed when nothing is measured");
  field("coast_frames", o.coast_frames, 0, 100,
        "frames for which it is believed at least, however slow they come");
  field("new_map_after_s", o.new_map_after_s, 0.0, 3600.0,
        "a lost camera that sees enough and recognises nothing for so long starts a new map");
}

class Tracker {
 public:
  Tracker(const TrackerOptions& options, const OrbOptions& orb, const Camera& camera, std::uint64_t seed);

  // `backlog`: keyframes requested earlier and not yet in the maps. Frames come with increasing timestamps; after a frame
  // that started a map, its keyframe is in the active one. Begins lost where maps are known from the start. A frame found
  // again in a dormant map asks for a keyframe there: whoever makes it makes that map the active one.
  // Throws InputError for images that do not fit the camera.
  TrackedFrame track(const RgbdFrame& frame, const KnownMaps& known, int backlog, TraceSink* trace);

 private:
  // The frame being worked on, and afterwards the last one.
  struct FrameState {
    std::int64_t index = 0;
    double timestamp_s = 0;
    std::shared_ptr<const FeatureSet> features;
    std::vector<LandmarkId> landmarks;  // per feature
    std::shared_ptr<const DepthGrid> surface;
    KeyframeId surface_reference;  // whose surfaces held the pose; invalid where they were not needed
    std::optional<TrackedLink> tracked_link;  // where landmarks are too few
    AnchoredPose pose;
  };

  void extract(const RgbdFrame& frame, TraceSink* trace);
  bool enough_to_start() const;
  TrackedFrame start();
  const KnownMap* place_last_frame(const KnownMaps& known);
  std::optional<FramePose> follow(const Map& map, double seconds, TraceSink* trace);
  // Where a lost frame was found.
  struct Found {
    const KnownMap* in = nullptr;
    FramePose pose;
  };
  std::optional<Found> relocalise(const KnownMaps& known, const KnownMap* last_in, TraceSink* trace);
  std::optional<FramePose> search_around(const Map& map, std::optional<MatchedPose> found, KeyframeId near,
                                         int min_inliers);
  std::optional<FramePose> match_recent(const Map& map, bool& guessed, TraceSink* trace);
  double match_last_frame(const Map& map, const Se3& predicted, double radius_px,
                          const std::function<void(const std::optional<FramePose>&, bool)>& found_pose);
  void match_points_of_last_frame(const Map& map, const Se3& predicted, double radius_px, bool landmarks);
  std::optional<FramePose> refine_on_local_map(const Map& map, const FramePose& guess, KeyframeId near,
                                               double radius_px);
  void project_local_map(const Map& map, const Se3& world_from_camera, double radius_px);
  // What landmarks are too few to tell, surfaces may. Returns the better pose, or `pose` where they do not.
  std::optional<FramePose> align_surfaces(const Map& map, const std::optional<FramePose>& pose,
                                          double seconds);
  std::optional<FramePose> find_by_surfaces(const Map& map, const SurfaceReference& reference,
                                            const PosePriorTerm& prior, double seconds);
  std::optional<FramePose> hold_by_surfaces(const Map& map, const SurfaceReference& reference,
                                            const Se3& guess, const PosePriorTerm& prior, double seconds);
  SurfaceReference choose_surface(const Map& map, const Se3& world_from_camera);
  void match_local_map(const Map& map, const Se3& world_from_camera, double radius_px);
  PosePriorTerm motion_prior(const Se3& predicted, double seconds) const;
  // Do the frame's surfaces lie where the keyframes around that pose saw them?
  bool surfaces_agree(const Map& map, const FramePose& pose);
  // Turned so far that the same poster in another room would be in view where the prediction looks for it.
  bool leaps(const FramePose& pose) const;
  // Or does it look through walls that any keyframe saw? A corner of another room may look, and stand, like this one.
  bool leaves_surfaces_standing(const Map& map, const FramePose& pose) const;
  const DepthGrid& surface_now() const { return *now_.surface; }
  bool believable(const Se3& world_from_now, double seconds) const;
  void note_sightings();
  void adopt_landmarks_of_own_keyframe(const Map& map);
  KeyframeId choose_anchor(KeyframeId near) const;
  TrackedFrame finish(const Map& map, const FramePose& pose, KeyframeId near, int backlog);
  TrackedFrame finish_relocalised(const KnownMaps& known, const Found& found, int backlog);
  TrackedFrame answer(const Map& map, const FramePose& pose, TrackStatus status, bool always_keep,
                      int backlog);
  TrackedFrame coast(const Map& map);
  bool loses_track() const;
  TrackedFrame stay_lost();
  std::vector<LandmarkId> matched_landmarks() const;
  KeyframeEvidence gather_evidence(const Map& map, const Se3& world_from_camera, int backlog) const;
  std::shared_ptr<const KeyframeRequest> make_request(const AnchoredPose& pose, bool first);
  TrackedFrame report(TrackStatus status, const Se3& world_from_camera) const;

  TrackerOptions options_;
  Camera camera_;
  ScalePyramid pyramid_;
  OrbExtractor extractor_;
  DepthAligner aligner_;
  Recovery recovery_;
  Image<std::uint8_t> grey_;

  MotionModel motion_;
  LocalMap local_map_;
  FrameMatches matches_;
  std::vector<ProjectedPoint> projections_;
  std::vector<LandmarkView> views_;
  // What happened to each landmark since the last keyframe request; put in order when handed over.
  struct Count {
    std::uint32_t visible = 0, found = 0;
  };
  struct HashId {
    std::size_t operator()(LandmarkId id) const { return id.index ^ (std::size_t{id.generation} << 32); }
  };
  std::unordered_map<LandmarkId, Count, HashId> sightings_;
  std::vector<LandmarkId> visible_now_;  // landmarks this frame should show

  std::optional<FrameState> last_;  // the last frame that had a pose
  std::optional<Se3> last_world_;   // its pose in the world of the map that holds it now, if one does
  Se3 predicted_;                   // where the motion model puts this frame
  FrameState now_;
  double last_measured_s_ = 0;  // when a pose was last measured, not coasted
  int unmeasured_frames_ = 0;
  bool lost_ = false;
  std::optional<double> searching_since_s_;  // when a lost camera first saw enough to start a map
  std::optional<AnchoredPose> last_keyframe_pose_;
  double last_keyframe_s_ = 0;
};

}  // namespace vsgraphs
