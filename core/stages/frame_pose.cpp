#include "core/stages/frame_pose.h"

#include <algorithm>

namespace vsgraphs {

void FrameMatches::reset(int feature_count) {
  all_.clear();
  taken_.assign(static_cast<std::size_t>(feature_count), 0);
}

void FrameMatches::add(const Correspondence& c) {
  all_.push_back(c);
  taken_[static_cast<std::size_t>(c.feature)] = 1;
}

void FrameMatches::keep(std::span<const std::uint8_t> flags) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (flags[i]) {
      all_[kept++] = all_[i];
    } else {
      taken_[static_cast<std::size_t>(all_[i].feature)] = 0;
    }
  }
  all_.resize(kept);
}

void FrameMatches::keep_landmarks_only() {
  std::vector<std::uint8_t> flags(all_.size());
  std::transform(all_.begin(), all_.end(), flags.begin(),
                 [](const Correspondence& c) { return static_cast<std::uint8_t>(c.landmark.valid()); });
  keep(flags);
}

}  // namespace vsgraphs
