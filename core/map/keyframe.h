// A keyframe: a frame kept for good, its pose a variable of the factor graph.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/fields.h"
#include "core/geometry/se3.h"
#include "core/map/depth_grid.h"
#include "core/map/features.h"
#include "core/map/ids.h"
#include "core/map/label_grid.h"
#include "core/map/surface_patch.h"

namespace vsgraphs {

// Where a keyframe stands as seen from another, as tracking measured it: by surfaces, or by points that never became
// landmarks. Made where landmarks are too few to hold the keyframe by themselves.
struct TrackedLink {
  KeyframeId to;
  Se3 to_from_camera;
  Matrix6d information = Matrix6d::Zero();  // tangent on the right of to_from_camera
};
template <FieldsOf<TrackedLink> T>
void visit_fields(T& v, auto& field) {
  auto& [to, to_from_camera, information] = v;
  field(to, to_from_camera, information);
}

// Odometry as measured: where a keyframe stands as seen from the one before it in time. Said once, by what the two and their
// neighbours in time saw, when local mapping is done with the keyframe, and never read from the map again: whatever is believed of
// loops later, this stays. Where the one before is culled, the step goes on to the one before that.
struct OdometryStep {
  KeyframeId
      before;  // it lives; an invalid one: nothing that was measured ties the keyframe to the one before
  Se3 before_from_camera;
  Matrix6d covariance = Matrix6d::Zero();  // tangent on the right of before_from_camera
};
template <FieldsOf<OdometryStep> T>
void visit_fields(T& v, auto& field) {
  auto& [before, before_from_camera, covariance] = v;
  field(before, before_from_camera, covariance);
}

struct Keyframe {
  std::int64_t frame_index = 0;
  double timestamp_s = 0;
  Se3 world_from_camera;
  std::shared_ptr<const FeatureSet> features;  // never changes; shared with every snapshot
  std::shared_ptr<const DepthGrid> surface;    // likewise
  std::shared_ptr<const KeyframeSurfaces>
      patches;  // planar pieces of `surface`; none before they were sought
  std::optional<TrackedLink> tracked_link;
  std::vector<LandmarkId> landmarks;  // per feature; invalid where none
  KeyframeId stretch;  // the first keyframe of its stretch (stretch.h); an invalid one begins one
  std::optional<OdometryStep> odometry;  // none yet while local mapping is at it
  std::shared_ptr<const ClassGrid>
      classes;  // that a segmenter named; null: none. Goes when the keyframe is culled
};
template <FieldsOf<Keyframe> T>
void visit_fields(T& v, auto& field) {
  auto& [frame_index, timestamp_s, world_from_camera, features, surface, patches, tracked_link, landmarks,
         stretch, odometry, classes] = v;
  field(frame_index, timestamp_s, world_from_camera, features, surface, patches, tracked_link, landmarks);
  field.since(3, stretch, odometry);
  field.since(5, classes);
}

// What is left of a keyframe that was culled: where it stood, seen from a keyframe that stayed.
struct RetiredKeyframe {
  KeyframeId anchor;
  Se3 anchor_from_camera;
  std::shared_ptr<const KeyframeSurfaces>
      patches;            // planes go on being where it saw them; null where no plane needs them
  bool replaced = false;  // by others that show all it saw
  KeyframeId stretch;     // as it was, too
};
template <FieldsOf<RetiredKeyframe> T>
void visit_fields(T& v, auto& field) {
  auto& [anchor, anchor_from_camera, patches, replaced, stretch] = v;
  field(anchor, anchor_from_camera, patches, replaced);
  field.since(3, stretch);
}

// A camera pose tied to a keyframe, so that corrections of the keyframe move it for free.
struct AnchoredPose {
  KeyframeId keyframe;
  Se3 keyframe_from_camera;
};

}  // namespace vsgraphs
