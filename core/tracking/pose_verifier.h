// Whether a pose is believed: do surfaces lie where the map has them, does the camera look through walls, could it have moved
// that far? A poster, or a corner of another room, may look and stand like this one.
#pragma once

#include "core/matching/local_map.h"
#include "core/tracking/depth_alignment.h"
#include "core/tracking/frame_step.h"
#include "core/tracking/recovery.h"

namespace vsgraphs {

class PoseVerifier {
 public:
  // `aligner` is borrowed for good.
  PoseVerifier(const RecoveryOptions& options, const Camera& camera, const DepthAligner& aligner)
      : options_(options), camera_(camera), aligner_(aligner) {}

  // Of a frame that was followed; `guessed`: its pose was found without the prediction. Costs nothing where the camera goes
  // on as it did, 0.1 ms for a guess; a leap 0.02 to 0.1 ms for each keyframe of the local map.
  bool follows(const FrameStep& step, const LocalMap& local_map, const FramePose& pose, bool guessed) const;

  // Of a frame found after a loss, in `map`: fits the surfaces around and looks through none of them. 0.02 to
  // 0.1 ms for each keyframe of the local map.
  bool fits(const Map& map, const LocalMap& local_map, const DepthGrid& surface, const FramePose& pose) const;

 private:
  bool surfaces_agree(const Map& map, const LocalMap& local_map, const DepthGrid& surface,
                      const FramePose& pose) const;
  bool leaves_surfaces_standing(const Map& map, const LocalMap& local_map, const DepthGrid& surface,
                                const Se3& world_from_camera) const;

  RecoveryOptions options_;
  Camera camera_;
  const DepthAligner& aligner_;
};

}  // namespace vsgraphs
