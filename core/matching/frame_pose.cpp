#include "core/matching/frame_pose.h"

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

void FrameMatches::keep_inliers(std::span<const ObservationFit> fit) {
  std::vector<std::uint8_t> flags(fit.size());
  std::transform(fit.begin(), fit.end(), flags.begin(),
                 [](ObservationFit f) { return static_cast<std::uint8_t>(is_inlier(f)); });
  keep(flags);
}

void FrameMatches::keep_landmarks_only() {
  std::vector<std::uint8_t> flags(all_.size());
  std::transform(all_.begin(), all_.end(), flags.begin(),
                 [](const Correspondence& c) { return static_cast<std::uint8_t>(c.landmark.valid()); });
  keep(flags);
}

std::vector<LandmarkId> FrameMatches::landmarks() const {
  std::vector<LandmarkId> ids;
  ids.reserve(all_.size());
  for (const Correspondence& c : all_) {
    if (c.landmark.valid()) ids.push_back(c.landmark);
  }
  return ids;
}

PoseObservation pose_observation(const Camera& camera, const ScalePyramid& pyramid, const Feature& feature,
                                 const Eigen::Vector3d& point_in_world) {
  PoseObservation o;
  o.point_in_world = point_in_world;
  o.u = static_cast<double>(feature.u);
  o.v = static_cast<double>(feature.v);
  o.inv_sigma_px = 1.0 / pyramid.level_sigma_px(feature.level);
  if (feature.has_depth()) {
    const double depth_m = static_cast<double>(feature.depth_m);
    o.inverse_depth = 1.0 / depth_m;
    o.inv_sigma_inverse_depth = inv_sigma_of_inverse_depth(camera.depth_noise, depth_m);
  }
  return o;
}

std::vector<PoseObservation> pose_observations(const Camera& camera, const ScalePyramid& pyramid,
                                               const FeatureSet& features, const FrameMatches& matches) {
  std::vector<PoseObservation> observations;
  observations.reserve(matches.all().size());
  for (const Correspondence& c : matches.all()) {
    observations.push_back(pose_observation(camera, pyramid, features[c.feature], c.point_in_world));
  }
  return observations;
}

FramePose solve_frame_pose(const Camera& camera, const ScalePyramid& pyramid, const FeatureSet& features,
                           const Se3& initial, FrameMatches& matches, std::span<const PointToPlane> planes) {
  const std::vector<PoseObservation> observations = pose_observations(camera, pyramid, features, matches);
  const PoseSolution solution = solve_pose(Intrinsics::of(camera), initial, observations, planes);
  matches.keep_inliers(solution.fit);
  return {solution.world_from_camera, solution.inliers,     !solution.degenerate,
          solution.information,       solution.information, solution.degenerate};
}

}  // namespace vsgraphs
