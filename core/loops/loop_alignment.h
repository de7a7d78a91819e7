// Where a keyframe stands as its features see it from a place the map knows from elsewhere: the geometric half of a loop's
// verification. A pose by descriptors alone (matching/descriptor_alignment.h), then all that lies around searched by
// projection, and the keyframe's neighbours asked whether they see the place too (after Campos et al., "ORB-SLAM3", T-RO
// 2021, section VI: verification by covisible keyframes instead of waiting for further ones).
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/base/options.h"
#include "core/base/rng.h"
#include "core/geometry/camera.h"
#include "core/map/map.h"
#include "core/matching/descriptor_alignment.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

struct LoopAlignmentOptions {
  int min_aligned = 20;
  int min_inliers = 40;
  int min_neighbour_inliers = 20;
  int supporters = 2;
  int strong_inliers = 120;
};

template <typename Visitor>
void describe(LoopAlignmentOptions& o, Visitor& field) {
  field("min_aligned", o.min_aligned, 10, 500,
        "least number of matches by descriptor that a loop's first alignment must explain");
  field("min_inliers", o.min_inliers, 15, 500,
        "least number of landmarks at the other end of a loop that the keyframe must observe");
  field("min_neighbour_inliers", o.min_neighbour_inliers, 10, 500,
        "least number of landmarks at the other end of a loop that a neighbour must observe to confirm it");
  field("supporters", o.supporters, 0, 5, "number of neighbours of the keyframe that must confirm a loop");
  field("strong_inliers", o.strong_inliers, 15, 5000,
        "a keyframe that observes this many landmarks at the other end needs one confirming neighbour less");
}

// A keyframe and those around it: the one its tracked link ties it to, then those that share landmarks, most first.
struct MappedPlace {
  KeyframeId centre;
  std::vector<KeyframeId> keyframes;  // centre first
};
MappedPlace place_around(const Map& map, KeyframeId centre, int max_keyframes);

// Landmarks the keyframes observe, each once, in the order of the keyframes and their features.
std::vector<LandmarkId> landmarks_of(const Map& map, const std::vector<KeyframeId>& keyframes);

struct LoopAlignment {
  KeyframeId keyframe;
  Se3 world_from_camera;  // as the place's landmarks have it; differs from the map's by what has to be corrected
  Matrix6d information = Matrix6d::Zero();         // tangent on the right of the pose
  std::vector<std::pair<int, LandmarkId>> sights;  // the keyframe's feature shows the place's landmark
};

class LoopAligner {
 public:
  LoopAligner(const LoopAlignmentOptions& options, const Camera& camera, const ScalePyramid& pyramid)
      : options_(options), camera_(camera), pyramid_(pyramid), by_descriptors_(camera, pyramid) {}

  // `keyframe` against `place`; `rng` draws the hypotheses. Cost: about 5 ms.
  std::optional<LoopAlignment> align(const Map& map, KeyframeId keyframe, const MappedPlace& place,
                                     Rng rng) const;

  // The keyframe's `neighbours` that, moved along with it, see the place where it should be.
  std::vector<KeyframeId> supporters(const Map& map, const LoopAlignment& alignment, const MappedPlace& place,
                                     const std::vector<KeyframeId>& neighbours) const;

 private:
  std::optional<LoopAlignment> search_around(const Map& map, KeyframeId keyframe,
                                             const Se3& world_from_camera,
                                             const std::vector<LandmarkId>& landmarks) const;

  LoopAlignmentOptions options_;
  Camera camera_;
  ScalePyramid pyramid_;
  DescriptorAligner by_descriptors_;
};

}  // namespace vsgraphs
