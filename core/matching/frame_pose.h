// From matched features to a camera pose: the glue between vision's matches and solve's pose solver.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/geometry/camera.h"
#include "core/map/features.h"
#include "core/map/ids.h"
#include "core/solve/pose_solver.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

// A feature of the frame that shows a point of the world; without an id where the point is only the last
// frame's own depth reading.
struct Correspondence {
  int feature = 0;
  LandmarkId landmark;
  Eigen::Vector3d point_in_world;
};

// Correspondences of one frame, at most one per feature.
class FrameMatches {
 public:
  void reset(int feature_count);
  void add(const Correspondence& c);
  bool taken(int feature) const { return taken_[static_cast<std::size_t>(feature)] != 0; }
  std::span<const std::uint8_t> taken() const { return taken_; }
  const std::vector<Correspondence>& all() const { return all_; }
  int size() const { return static_cast<int>(all_.size()); }
  // Keeps those whose flag is set.
  void keep(std::span<const std::uint8_t> flags);
  // Keeps those that a solver's answer fits; one entry per match, in their order.
  void keep_inliers(std::span<const ObservationFit> fit);
  // Drops those that have no landmark.
  void keep_landmarks_only();
  // The landmarks matched, in the order of the matches.
  std::vector<LandmarkId> landmarks() const;

 private:
  std::vector<Correspondence> all_;
  std::vector<std::uint8_t> taken_;
};

struct FramePose {
  Se3 world_from_camera;
  int inliers = 0;
  bool trustworthy = false;                 // solved, and the six directions are all held by measurements
  Matrix6d information = Matrix6d::Zero();  // of the measurements, tangent on the right of the pose
  Matrix6d measured = Matrix6d::Zero();  // the same with everything that was measured, surfaces and features
  bool degenerate = false;               // part of the pose is only what the motion model predicted
};

// A pose and what holds it.
struct MatchedPose {
  FramePose pose;
  FrameMatches matches;
  KeyframeId surface_reference;  // whose surfaces hold it; invalid where matches alone do
};

// Weights of one feature's measurements, from the level it was found at and the sensor's depth noise.
PoseObservation pose_observation(const Camera& camera, const ScalePyramid& pyramid, const Feature& feature,
                                 const Eigen::Vector3d& point_in_world);

// The same for all matches of a frame, in their order.
std::vector<PoseObservation> pose_observations(const Camera& camera, const ScalePyramid& pyramid,
                                               const FeatureSet& features, const FrameMatches& matches);

// Solves for the pose from `initial` and drops outliers from `matches`. `planes`: samples of the frame's depth on mapped
// planes, if any. Cost: about 0.2 ms for 500 matches.
FramePose solve_frame_pose(const Camera& camera, const ScalePyramid& pyramid, const FeatureSet& features,
                           const Se3& initial, FrameMatches& matches,
                           std::span<const PointToPlane> planes = {});

}  // namespace vsgraphs
