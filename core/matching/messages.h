// What the stages say to one another: plain values, never changed once sent.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/image.h"
#include "core/map/map.h"
#include "core/vision/depth_lookup.h"
#include "core/vision/place_index.h"

namespace vsgraphs {

// One colour and depth image pair, borrowed from the caller for the length of one call.
// Exactly one of `colour` and `grey` is filled.
struct RgbdFrame {
  std::int64_t index = 0;
  double timestamp_s = 0;
  ImageView<Rgb> colour;
  ImageView<std::uint8_t> grey;
  DepthView depth;
};

// A map, and the index that finds its keyframes by what they show.
struct KnownMap {
  Snapshot map;
  std::shared_ptr<const PlaceIndex> places;
};

// What a frame can be looked up in: the map being worked on, and others, each in a world of its own. Ids are disjoint.
struct KnownMaps {
  KnownMap active;
  std::vector<KnownMap> dormant;
  // Nothing to be lost in.
  bool empty() const { return active.map->keyframes().size() == 0 && dormant.empty(); }
};

enum class TrackStatus {
  waiting,      // no map yet and not enough depth to start one
  initialised,  // this frame started a map
  ok,           // pose measured
  coasting,     // pose predicted: nothing trustworthy was measured, for a moment
  lost,         // no pose
  relocalised,  // pose measured again after a loss
};

const char* to_string(TrackStatus status);
inline bool has_pose(TrackStatus s) { return s != TrackStatus::waiting && s != TrackStatus::lost; }

// How often a landmark should have been seen, and was, since the last keyframe.
struct Sighting {
  LandmarkId landmark;
  std::uint32_t visible = 0;
  std::uint32_t found = 0;
};

// A frame the tracker wants kept. Also all the mapper ever learns of ordinary frames.
struct KeyframeRequest {
  std::int64_t frame_index = 0;
  double timestamp_s = 0;
  bool first = false;  // starts the map: `pose` has no anchor, the camera stands at the world's origin
  AnchoredPose pose;
  std::shared_ptr<const FeatureSet> features;
  std::shared_ptr<const DepthGrid> surface;
  std::optional<TrackedLink> tracked_link;
  std::vector<LandmarkId> landmarks;  // per feature, as matched by the tracker
  std::vector<Sighting> sightings;
};

struct TrackedFrame {
  std::int64_t index = 0;
  double timestamp_s = 0;
  TrackStatus status = TrackStatus::waiting;
  // Valid if has_pose(status); a frame that starts a map names no keyframe, as its own is yet to be made.
  AnchoredPose pose;
  Se3 world_from_camera;                                    // the same in the world of the map it is in
  int matches = 0;                                          // inlier correspondences behind the pose
  std::shared_ptr<const KeyframeRequest> keyframe_request;  // set if the frame should become a keyframe
};

}  // namespace vsgraphs
