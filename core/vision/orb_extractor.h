// From an image to its features: ORB corners spread over the image and its scales, with depth and colour.
// Own implementation after Rublee et al. (ICCV 2011), FAST after Rosten and Drummond (ECCV 2006).
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/map/features.h"
#include "core/vision/depth_lookup.h"
#include "core/vision/fast_corners.h"
#include "core/vision/grey_pyramid.h"
#include "core/vision/scale_pyramid.h"
#include "core/vision/spread.h"
#include "core/vision/steered_brief.h"
#include "core/vision/undistort_grid.h"

namespace vsgraphs {

struct OrbOptions {
  int max_features = 1000;     // 1..20000
  int levels = 8;              // pyramid levels, 1..16
  double scale_factor = 1.2;   // size ratio of neighbouring levels, 1.05..2
  int fast_threshold = 20;     // grey steps a corner needs, 2..254
  int fast_threshold_low = 7;  // grey steps where a part of the image has no such corner, 1..fast_threshold

  ScalePyramid pyramid() const { return {levels, scale_factor}; }
  // Throws InputError naming the first option out of its range.
  void validate() const;
};

template <typename Visitor>
void describe(OrbOptions& o, Visitor& field) {
  field("max_features", o.max_features, 1, 20000, "largest number of features kept per frame");
  field("levels", o.levels, 1, 16, "number of levels of the image pyramid");
  field("scale_factor", o.scale_factor, 1.05, 2.0, "ratio of the sizes of neighbouring pyramid levels");
  field("fast_threshold", o.fast_threshold, 2, 254, "difference in grey levels, of 255, that makes a corner");
  field("fast_threshold_low", o.fast_threshold_low, 1, 254,
        "difference in grey levels, of 255, that makes a corner where a part of the image has no other; at "
        "most fast_threshold");
}

// Not thread-safe: one per thread. Owns its buffers (about 3 MB at 640x480) and keeps them between calls.
class OrbExtractor {
 public:
  // Throws InputError if the options or the camera make no sense.
  OrbExtractor(const OrbOptions& options, const Camera& camera);

  // Features of one frame, strongest first, so that any prefix is a well-spread choice of the best. Positions
  // are undistorted; depth and colour are read at the distorted pixel. `colour` may be empty (colours stay
  // black). The same input gives the same bytes. Throws InputError if a size differs from the camera's.
  // About 2.5 ms for 640x480 and 1000 features.
  FeatureSet extract(const ImageView<std::uint8_t>& grey, const DepthView& depth,
                     const ImageView<Rgb>& colour);

  const ScalePyramid& pyramid() const { return scales_; }

 private:
  struct Keypoint {
    std::uint64_t order = 0;  // ascending: rank in its cell, then score, then level and place
    Corner corner;
    std::uint8_t level = 0;
  };
  void find_keypoints();
  Feature place(const Keypoint& keypoint, const DepthView& depth, const ImageView<Rgb>& colour) const;

  OrbOptions options_;
  Camera camera_;
  ScalePyramid scales_;
  std::vector<int> wanted_;  // features per level
  GreyPyramid grey_;
  SteeredBrief brief_;
  DepthLookup depth_;
  UndistortGrid undistort_;
  FastCorners fast_;
  CornerSpread spread_;
  std::vector<Corner> corners_;
  std::vector<ChosenCorner> chosen_;
  std::vector<Keypoint> keypoints_;
};

}  // namespace vsgraphs
