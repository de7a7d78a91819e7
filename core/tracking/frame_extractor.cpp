#include "core/tracking/frame_extractor.h"

#include "core/vision/grey.h"

namespace vsgraphs {

FrameState FrameExtractor::extract(const RgbdFrame& frame) {
  FrameState now;
  now.index = frame.index;
  now.timestamp_s = frame.timestamp_s;
  ImageView<std::uint8_t> grey = frame.grey;
  if (grey.empty()) {
    to_grey(frame.colour, grey_);
    grey = grey_.view();
  }
  now.features = std::make_shared<const FeatureSet>(orb_.extract(grey, frame.depth, frame.colour));
  now.surface = std::make_shared<const DepthGrid>(sampler_.sample(frame.depth));
  now.landmarks.assign(static_cast<std::size_t>(now.features->size()), LandmarkId{});
  return now;
}

}  // namespace vsgraphs
