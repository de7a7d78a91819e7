// A long painted wall, and what a camera sees of it that stands 2 m before it and is put along it by whole pixels, so that its
// truth is known exactly.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/rng.h"
#include "core/matching/messages.h"
#include "core/system/config/config.h"
#include "core/vision/test_painted_wall.h"

namespace vsgraphs::test {

inline constexpr int width = painted_view_width, height = painted_view_height, wall_px = 1000;
inline constexpr double wall_m = 2.0, metres_per_px = wall_m / painted_view_focal_px, frame_s = 0.1;

inline Camera small_camera() { return painted_wall_camera(1 / frame_s); }

inline Image<std::uint8_t> long_wall(int seed) {
  return painted_wall(wall_px, 2300, Rng(seed, "long_wall", 0));
}

inline Config configured(const std::string& execution) {
  Config config;
  config.set("system.execution", execution);
  config.set("tracker.new_map_after_s", 0.3);
  config.set("system.min_map_keyframes", std::int64_t{2});
  return config;
}

// What the camera sees of the wall, frame after frame, and where it truly was.
class WallScene {
 public:
  static constexpr int nowhere = -1;

  // From `px` pixels along the wall.
  RgbdFrame seen_from(int px) { return before(wall_, px, px); }
  // From somewhere along another wall, nowhere near.
  RgbdFrame seen_elsewhere(int px) { return before(other_wall_, px, nowhere); }
  RgbdFrame in_the_dark() { return frame(dark_.view(), no_depth_.view(), nowhere); }
  // Empty in the dark.
  std::optional<Eigen::Vector3d> truth(double timestamp_s) const {
    const int px = seen_px_[static_cast<std::size_t>(std::lround(timestamp_s / frame_s))];
    if (px == nowhere) return std::nullopt;
    return Eigen::Vector3d(px * metres_per_px, 0, 0);
  }

 private:
  RgbdFrame before(const Image<std::uint8_t>& wall, int px, int truth_px) {
    const ImageView<std::uint8_t> all = wall.view();
    return frame({all.data + px, width, height, all.stride}, depth_.view(), truth_px);
  }
  RgbdFrame frame(const ImageView<std::uint8_t>& grey, const ImageView<float>& depth, int px) {
    RgbdFrame frame;
    frame.index = std::ssize(seen_px_);
    frame.timestamp_s = frame_s * static_cast<double>(seen_px_.size());
    frame.grey = grey;
    frame.depth.metres = depth;
    seen_px_.push_back(px);
    return frame;
  }

  Image<std::uint8_t> wall_ = long_wall(11), other_wall_ = long_wall(12), dark_{width, height, 0};
  Image<float> depth_{width, height, static_cast<float>(wall_m)}, no_depth_{width, height, 0.0F};
  std::vector<int> seen_px_;
};

}  // namespace vsgraphs::test
