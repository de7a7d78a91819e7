// From a frame's images to what tracking works on: ORB features with depth, and samples of its surfaces.
#pragma once

#include "core/geometry/camera.h"
#include "core/matching/messages.h"
#include "core/tracking/frame_state.h"
#include "core/vision/depth_sampling.h"
#include "core/vision/orb_extractor.h"

namespace vsgraphs {

class FrameExtractor {
 public:
  FrameExtractor(const OrbOptions& orb, const Camera& camera) : orb_(orb, camera), sampler_(camera) {}

  // A frame without landmarks or pose. Throws InputError for images that do not fit the camera. About 2.5 ms at 640x480.
  FrameState extract(const RgbdFrame& frame);

 private:
  OrbExtractor orb_;
  DepthSampler sampler_;
  Image<std::uint8_t> grey_;
};

}  // namespace vsgraphs
