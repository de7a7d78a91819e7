// Where corners are rare, surfaces tell the pose: samples of the frame's depth are laid against the depth of a
// keyframe by projective association and point-to-plane distance (Blais and Levine, PAMI 1995; Newcombe et al.,
// KinectFusion, ISMAR 2011), together with whatever features were matched and with what the motion model knows.
// What surfaces cannot hold, such as the way along a blank corridor, stays with the prediction and is said to be.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/geometry/camera.h"
#include "core/map/map.h"
#include "core/solve/pose_solver.h"
#include "core/vision/depth_sampling.h"

namespace vsgraphs {

// Surfaces to lay a frame against: a keyframe's, or an earlier frame's that hangs on that keyframe.
struct SurfaceReference {
  KeyframeId id;
  Se3 world_from_surface;
  const DepthGrid* grid = nullptr;
};

struct DepthAlignment {
  PoseSolution solution;
  int associated = 0;  // samples that met a surface of the reference
  int agreeing = 0;    // of them, on it within noise
  Matrix6d surface_information =
      Matrix6d::Zero();      // of the agreeing samples alone, right-hand tangent of the pose
  bool convincing() const;   // enough samples, most of which agree
  bool contradicts() const;  // enough samples, too many of which disagree
};

class DepthAligner {
 public:
  explicit DepthAligner(const Camera& camera) : camera_(camera), sampler_(camera) {}

  const DepthSampler& sampler() const { return sampler_; }

  // From `initial`, with `features` (may be empty), the map's planes and a prior. About 0.5 ms.
  DepthAlignment align(const Map& map, const DepthGrid& now, const SurfaceReference& reference,
                       const Se3& initial, std::span<const PoseObservation> features,
                       const PosePriorTerm& prior) const;

  // How well the frame's surfaces fit the reference's at a given pose; nothing is solved. For judging a pose that
  // was found in another way.
  DepthAlignment judge(const DepthGrid& now, const SurfaceReference& reference,
                       const Se3& world_from_camera) const;

 private:
  // `skip`: samples that are left out; may be empty.
  std::vector<PointToPlane> associate(const DepthGrid& now, const SurfaceReference& reference,
                                      const Se3& pose, double gate_m,
                                      const std::vector<std::uint8_t>& skip = {}) const;
  void count(const std::vector<PointToPlane>& rows, const Se3& pose, DepthAlignment& result) const;

  Camera camera_;
  DepthSampler sampler_;
};

}  // namespace vsgraphs
