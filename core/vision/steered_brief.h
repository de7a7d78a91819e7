// ORB's orientation and descriptor (Rublee et al., "ORB: an efficient alternative to SIFT or SURF", ICCV
// 2011): the patch's intensity centroid gives an angle (Rosin 1999), and the comparisons of BRIEF (Calonder
// et al., ECCV 2010) are turned by it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/map/features.h"

namespace vsgraphs {

// What a patch reaches from its centre; a corner must lie at least patch_reach_px + 1 from every edge.
inline constexpr int patch_reach_px = 15;

// Direction from the patch's centre to its centroid of intensity within a disc of radius 15 px; rad, -pi..pi,
// clockwise on the screen (v points down).
float patch_angle(const ImageView<std::uint8_t>& image, int x, int y);

class SteeredBrief {
 public:
  // Tables of pixel offsets for images of one stride.
  explicit SteeredBrief(std::ptrdiff_t stride);

  // Descriptor of the patch at (x, y) of a smoothed image with that stride; about 0.4 us.
  Descriptor describe(const ImageView<std::uint8_t>& blurred, int x, int y, float angle_rad) const;

 private:
  // Finer steps match better (32: 4 % fewer pairs, 256: 1 % more); 256 kB of tables stay in the second cache.
  static constexpr int angles = 128;
  struct Pair {
    std::int32_t first, second;
  };
  std::ptrdiff_t stride_;
  std::vector<Pair> offsets_;  // 256 pairs per angle
};

}  // namespace vsgraphs
