#include "simulate/truth.h"

#include <algorithm>

#include "core/base/check.h"

namespace vsgraphs {

ObservationCounter::ObservationCounter(const Scene& scene)
    : scene_(scene),
      seen_(scene.instances.size()),
      pixels_(scene.instances.size()),
      visited_(scene.rooms.size()),
      histogram_(scene.instances.size()) {}

void ObservationCounter::add(const Image<std::uint16_t>& instances, const Eigen::Vector3d& camera_in_world) {
  VSG_INVARIANT(frames_ == 0 || pixels_per_frame_ == instances.pixels.size());
  pixels_per_frame_ = instances.pixels.size();
  std::fill(histogram_.begin(), histogram_.end(), 0u);
  for (const std::uint16_t id : instances.pixels) {
    VSG_INVARIANT(id < histogram_.size());
    ++histogram_[id];
  }
  for (std::size_t i = 0; i < histogram_.size(); ++i) {
    const double share = static_cast<double>(histogram_[i]) / static_cast<double>(instances.pixels.size());
    pixels_[i] += histogram_[i];
    seen_[i] += share >= min_share;
  }
  for (std::size_t r = 0; r < visited_.size(); ++r) {
    const RoomPlan& room = scene_.plan.rooms[r];
    if (contains(room.polygon, camera_in_world.head<2>()) && camera_in_world.z() > room.z_floor &&
        camera_in_world.z() < room.z_floor + room.height)
      visited_[r] = true;
  }
  ++frames_;
}

double ObservationCounter::mean_share(std::uint16_t instance) const {
  if (frames_ == 0) return 0;
  return static_cast<double>(pixels_[instance]) / static_cast<double>(pixels_per_frame_) / frames_;
}

bool ObservationCounter::observed(std::uint16_t instance) const {
  return frames_ > 0 && seen_[instance] >= std::min(min_frames, frames_);
}

}  // namespace vsgraphs
