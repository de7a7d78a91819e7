// Where the camera looked through and where its rays ended: integer counts in a sparse voxel grid, so that what one
// keyframe contributed can be taken out exactly and put in again where a correction moved it.
// Ray traversal: Amanatides, Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987. Hashed blocks:
// Niessner et al., "Real-time 3D Reconstruction at Scale using Voxel Hashing", SIGGRAPH Asia 2013. Rays that end in one voxel are carved as
// one: Oleynikova et al., "Voxblox", IROS 2017.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/base/fields.h"
#include "core/base/options.h"
#include "core/geometry/se3.h"
#include "core/map/depth_grid.h"
#include "core/map/ids.h"
#include "core/scene/space/voxel_blocks.h"

namespace vsgraphs {

struct FreeSpaceOptions {
  double voxel_m = 0.1;
  double range_m = 4.0;
  int max_blocks = 60000;
  double moved_m = 0.03;
  double turned_deg = 0.5;
};
template <FieldsOf<FreeSpaceOptions> T>
void visit_fields(T& v, auto& field) {
  auto& [voxel_m, range_m, max_blocks, moved_m, turned_deg] = v;
  field(voxel_m, range_m, max_blocks, moved_m, turned_deg);
}

template <typename Visitor>
void describe(FreeSpaceOptions& o, Visitor& field) {
  field("voxel_m", o.voxel_m, 0.05, 0.2, "edge length of a voxel, in metres");
  field("range_m", o.range_m, 1.0, 10.0, "largest distance up to which rays carve free space, in metres");
  field("max_blocks", o.max_blocks, 100, 1000000,
        "largest number of voxel blocks (8 x 8 x 8 voxels, at most 8 kB each); beyond it further keyframes "
        "are left out of free space");
  field("moved_m", o.moved_m, 0.001, 1.0,
        "a keyframe corrected by more than this, in metres, carves its free space anew");
  field("turned_deg", o.turned_deg, 0.01, 20.0,
        "a keyframe turned by more than this, in degrees, carves its free space anew");
}

struct KeyframePose {
  KeyframeId keyframe;
  Se3 level_from_camera;
};

// How far a camera stands from where it was carved; beyond 1 it is carved again.
double off_by(const Se3& as_carved, const Se3& now, const FreeSpaceOptions& options);

// Rays of one keyframe that end in one voxel.
struct RayBundle {
  Eigen::Vector3d to;  // the first one's end
  std::uint32_t rays = 0;
  bool hits = false;  // false: cut off at the range
};

// Frame: levelled (z up, metres), the caller's. Not thread-safe.
class FreeSpace {
 public:
  struct View {
    std::shared_ptr<const DepthGrid> depth;  // null: frozen
    Se3 level_from_camera;                   // as it was carved

    template <FieldsOf<View> T>
    friend void visit_fields(T& v, auto& field) {
      field(v.depth, v.level_from_camera);
      if constexpr (std::remove_reference_t<decltype(field)>::reads)
        field.require(v.level_from_camera.finite(), "a view from nowhere");
    }
  };

  explicit FreeSpace(const FreeSpaceOptions& options);

  // Carves a keyframe's rays, taking out first what it had carved before. A sample without a reading carves nothing; one
  // beyond the range carves up to it and hits nothing. False, and nothing changes: memory is full. About 2 ms for 80 x
  // 60 samples.
  bool integrate(KeyframeId keyframe, std::shared_ptr<const DepthGrid> depth, const Se3& level_from_camera);
  // Takes a keyframe's rays out again; nothing happens if it was never carved.
  void remove(KeyframeId keyframe);
  // Carves those keyframes again that have moved the most (by the options' measures), at most
  // `max_reintegrations` of them; those without a pose stay where they are. Returns how many still wait.
  int refresh(std::span<const KeyframePose> poses, int max_reintegrations);
  // Lets go of a keyframe's depth: what it carved stays as it is for good, whatever is asked above.
  void freeze(KeyframeId keyframe);
  // Gives the memory of blocks back in which nothing is left.
  void drop_empty();
  // From now on; voxel_m and range_m must be those it has.
  void use(const FreeSpaceOptions& options);

  const VoxelBlocks& voxels() const { return voxels_; }
  const std::map<KeyframeId, View>& views() const { return views_; }
  const FreeSpaceOptions& options() const { return options_; }
  // Of the grid; the depth samples belong to the keyframes.
  std::size_t memory_bytes() const { return voxels_.memory_bytes(); }
  // Changes whenever a voxel may have.
  std::uint64_t version() const { return version_; }

  template <FieldsOf<FreeSpace> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.options_, v.voxels_, v.views_, v.version_);
    if constexpr (std::remove_reference_t<decltype(field)>::reads)
      field.require(v.options_.voxel_m >= 1e-3 && v.options_.range_m <= 1e3, "voxels of no size");
  }

 private:
  void carve(const View& view, int sign);
  void carve_ray(const Eigen::Vector3d& from, const RayBundle& bundle, int sign);

  FreeSpaceOptions options_;
  VoxelBlocks voxels_;
  std::map<KeyframeId, View> views_;
  std::uint64_t version_ = 0;
};

}  // namespace vsgraphs
