#include "core/scene/space/free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

// Steps from voxel to voxel along a ray, keeping the block at hand: most steps stay within it.
class VoxelWalk {
 public:
  // `from` and `to` in voxels.
  VoxelWalk(VoxelBlocks& blocks, const Eigen::Vector3d& from, const Eigen::Vector3d& to) : blocks_(blocks) {
    const Eigen::Vector3d way = to - from;
    for (int a = 0; a < 3; ++a) {
      voxel_[a] = static_cast<int>(std::floor(from[a]));
      const int last = static_cast<int>(std::floor(to[a]));
      steps_ += std::abs(last - voxel_[a]);
      step_[a] = way[a] > 0 ? 1 : -1;
      const double boundary = voxel_[a] + (way[a] > 0 ? 1 : 0);
      const bool crosses = last != voxel_[a];
      next_[a] = crosses ? (boundary - from[a]) / way[a] : std::numeric_limits<double>::infinity();
      delta_[a] = crosses ? std::abs(1.0 / way[a]) : std::numeric_limits<double>::infinity();
    }
    enter();
  }
  int steps() const { return steps_; }  // voxels behind the first
  Voxel& voxel() { return block_->at(in_block_.x(), in_block_.y(), in_block_.z()); }
  void advance() {
    const int a = next_[0] < next_[1] ? (next_[0] < next_[2] ? 0 : 2) : (next_[1] < next_[2] ? 1 : 2);
    next_[a] += delta_[a];
    voxel_[a] += step_[a];
    in_block_[a] += step_[a];
    if (static_cast<unsigned>(in_block_[a]) >= VoxelBlocks::edge) enter();
  }

 private:
  void enter() {
    block_ = &blocks_.block(voxel_);
    in_block_ = voxel_ - block_->origin;
  }

  VoxelBlocks& blocks_;
  VoxelBlocks::Block* block_ = nullptr;
  Eigen::Vector3i voxel_, in_block_, step_;
  Eigen::Vector3d next_, delta_;  // share of the way at which the next boundary is crossed
  int steps_ = 0;
};

// Finds the bundle that ends in a voxel: open addressing, sized for one keyframe.
class EndVoxels {
 public:
  explicit EndVoxels(std::size_t rays) {
    std::size_t slots = 64;
    while (slots < 2 * rays) slots *= 2;
    slots_.assign(slots, -1);
    keys_.reserve(rays);
  }
  // The number of the voxel among those asked for, counted from 0 in the order they first came.
  std::size_t number(const Eigen::Vector3i& voxel) {
    // 21 bits per axis: 200 km at 0.1 m.
    const auto bits = [](int i) {
      return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i) & 0x1fffffu);
    };
    const std::uint64_t key = bits(voxel.x()) << 42 | bits(voxel.y()) << 21 | bits(voxel.z());
    std::size_t slot = (key * 0x9e3779b97f4a7c15ULL >> 20) & (slots_.size() - 1);
    while (slots_[slot] >= 0 && keys_[static_cast<std::size_t>(slots_[slot])] != key)
      slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] < 0) {
      slots_[slot] = static_cast<std::int32_t>(keys_.size());
      keys_.push_back(key);
    }
    return static_cast<std::size_t>(slots_[slot]);
  }

 private:
  std::vector<std::int32_t> slots_;
  std::vector<std::uint64_t> keys_;
};

// Near surfaces send many rays from one voxel; they are followed once.
std::vector<RayBundle> bundles_of(const FreeSpace::View& view, const FreeSpaceOptions& options) {
  std::vector<RayBundle> bundles;
  EndVoxels ends(view.depth->samples.size());
  const Se3& pose = view.level_from_camera;
  for (const SurfaceSample& sample : view.depth->samples) {
    if (!(sample.point.z() > 0)) continue;
    const Eigen::Vector3d ray = pose.rotation() * sample.point.cast<double>();
    const double length = ray.norm();
    const bool hits = length <= options.range_m;
    const Eigen::Vector3d to = pose.translation() + (hits ? 1.0 : options.range_m / length) * ray;
    const Eigen::Vector3i voxel = (to / options.voxel_m).array().floor().cast<int>();
    const std::size_t number = ends.number(voxel);
    if (number == bundles.size())
      bundles.push_back({to, 1, hits});
    else
      ++bundles[number].rays;
  }
  return bundles;
}

}  // namespace

double off_by(const Se3& as_carved, const Se3& now, const FreeSpaceOptions& options) {
  const Se3 change = as_carved.inverse() * now;
  const double turned_deg = rotation_angle(change.rotation()) * 180 / std::numbers::pi;
  return std::max(change.translation().norm() / options.moved_m, turned_deg / options.turned_deg);
}

FreeSpace::FreeSpace(const FreeSpaceOptions& options) : options_(options) {}

bool FreeSpace::integrate(KeyframeId keyframe, std::shared_ptr<const DepthGrid> depth,
                          const Se3& level_from_camera) {
  const auto full = [this] {
    return voxels_.blocks().size() >= static_cast<std::size_t>(options_.max_blocks);
  };
  if (full()) voxels_.drop_empty();
  if (full()) return false;
  remove(keyframe);
  if (views_.contains(keyframe)) return true;
  const View& view = views_[keyframe] = {std::move(depth), level_from_camera};
  carve(view, 1);
  return true;
}

void FreeSpace::remove(KeyframeId keyframe) {
  const auto it = views_.find(keyframe);
  if (it == views_.end() || !it->second.depth) return;
  carve(it->second, -1);
  views_.erase(it);
}

int FreeSpace::refresh(std::span<const KeyframePose> poses, int max_reintegrations) {
  std::vector<std::pair<double, const KeyframePose*>> moved;
  for (const KeyframePose& pose : poses) {
    const auto it = views_.find(pose.keyframe);
    if (it == views_.end() || !it->second.depth) continue;
    const double by = off_by(it->second.level_from_camera, pose.level_from_camera, options_);
    if (by > 1) moved.emplace_back(by, &pose);
  }
  std::sort(moved.begin(), moved.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second->keyframe < b.second->keyframe;
  });
  const std::size_t count = std::min(moved.size(), static_cast<std::size_t>(std::max(0, max_reintegrations)));
  for (std::size_t i = 0; i < count; ++i) {
    View& view = views_.at(moved[i].second->keyframe);
    carve(view, -1);
    view.level_from_camera = moved[i].second->level_from_camera;
    carve(view, 1);
  }
  return static_cast<int>(moved.size() - count);
}

void FreeSpace::freeze(KeyframeId keyframe) {
  const auto it = views_.find(keyframe);
  if (it != views_.end()) it->second.depth.reset();
}

void FreeSpace::drop_empty() { voxels_.drop_empty(); }

void FreeSpace::use(const FreeSpaceOptions& options) {
  VSG_INVARIANT(options.voxel_m == options_.voxel_m && options.range_m == options_.range_m);
  options_ = options;
}

void FreeSpace::carve(const View& view, int sign) {
  ++version_;
  for (const RayBundle& bundle : bundles_of(view, options_))
    carve_ray(view.level_from_camera.translation(), bundle, sign);
}

void FreeSpace::carve_ray(const Eigen::Vector3d& from, const RayBundle& bundle, int sign) {
  VoxelWalk walk(voxels_, from / options_.voxel_m, bundle.to / options_.voxel_m);
  const std::uint32_t change = sign > 0 ? bundle.rays : 0u - bundle.rays;
  for (int i = 0; i < walk.steps(); ++i, walk.advance()) walk.voxel().passes += change;
  (bundle.hits ? walk.voxel().hits : walk.voxel().passes) += change;
}

}  // namespace vsgraphs
