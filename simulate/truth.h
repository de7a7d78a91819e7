// What a sequence's truth file says beyond the scene itself: what the camera saw, for how long, and where it went.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "simulate/scene.h"

namespace vsgraphs {

// Counts what was seen, frame by frame; the order does not matter.
class ObservationCounter {
 public:
  explicit ObservationCounter(const Scene& scene);

  // A surface counts as seen in a frame when it fills at least this share of the image.
  static constexpr double min_share = 0.02;
  // ... and as observed at all after this many such frames (or all of a shorter sequence).
  static constexpr int min_frames = 5;

  void add(const Image<std::uint16_t>& instances, const Eigen::Vector3d& camera_in_world);

  int frames() const { return frames_; }
  int frames_seen(std::uint16_t instance) const { return seen_[instance]; }
  double mean_share(std::uint16_t instance) const;  // of the image, over all frames
  bool observed(std::uint16_t instance) const;
  bool visited(int room) const { return visited_[static_cast<std::size_t>(room)]; }

 private:
  const Scene& scene_;
  int frames_ = 0;
  std::vector<int> seen_;
  std::vector<std::uint64_t> pixels_;  // whole numbers: sums do not depend on the order of frames
  std::uint64_t pixels_per_frame_ = 0;
  std::vector<bool> visited_;
  std::vector<std::uint32_t> histogram_;
};

}  // namespace vsgraphs
