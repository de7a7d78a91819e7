// A made-up window with exact truth, for tests and benchmarks of the solvers.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/rng.h"
#include "core/solve/bundle_adjustment.h"
#include "core/solve/pose_solver.h"

namespace vsgraphs {

struct SyntheticWindowOptions {
  int fixed_poses = 10, free_poses = 20, landmarks = 3000, views_per_landmark = 5;
  double pixel_sigma = 1.0;
  double depth_share = 0.7;    // observations with a depth reading
  double outlier_share = 0.0;  // observations moved by 30 to 80 px
  double pose_error_m = 0.02, pose_error_rad = 0.01, landmark_error_m = 0.03;  // of the start
  bool noise = true;
};

struct SyntheticWindow {
  BundleProblem problem;  // perturbed start
  std::vector<Se3> true_poses;
  std::vector<Eigen::Vector3d> true_landmarks;
  std::vector<std::uint8_t> planted;  // per observation: an outlier
};

inline Vector6d random_tangent(Rng& rng, double metres, double radians) {
  Vector6d xi;
  for (int i = 0; i < 3; ++i) xi[i] = metres * rng.normal();
  for (int i = 3; i < 6; ++i) xi[i] = radians * rng.normal();
  return xi;
}

// Camera k of an arc of radius 0.5 m that looks outward at a curved wall of points 1.5 to 4 m away.
inline Se3 camera_on_arc(double angle) {
  const Eigen::Vector3d forward(std::sin(angle), 0.05 * std::sin(3 * angle), std::cos(angle));
  const Eigen::Vector3d z = forward.normalized(), x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Matrix3d rotation;
  rotation << x, z.cross(x), z;
  return {rotation, 0.5 * forward + Eigen::Vector3d(0, 0.1 * std::sin(5 * angle), 0.02 * angle)};
}

inline ReprojectionObservation observe(const Intrinsics& k, const Se3& pose, const Eigen::Vector3d& point,
                                       const SyntheticWindowOptions& options, Rng& rng) {
  const Eigen::Vector3d p = pose.inverse() * point;
  const int level = static_cast<int>(rng.index(4));
  const double sigma = options.pixel_sigma * std::pow(1.2, level);
  const Eigen::Vector2d px = k.project(p);
  const double noise = options.noise ? 1.0 : 0.0;
  ReprojectionObservation o;
  o.u = static_cast<float>(px.x() + noise * sigma * rng.normal());
  o.v = static_cast<float>(px.y() + noise * sigma * rng.normal());
  o.inv_sigma_px = static_cast<float>(1.0 / sigma);
  if (rng.uniform() < options.depth_share) {
    const double inv_sigma = inv_sigma_of_inverse_depth(DepthNoise{}, p.z());
    o.inverse_depth = static_cast<float>(1.0 / p.z() + noise * rng.normal() / inv_sigma);
    o.inv_sigma_inverse_depth = static_cast<float>(inv_sigma);
  }
  return o;
}

inline SyntheticWindow synthetic_window(const SyntheticWindowOptions& options, std::uint64_t seed = 1) {
  Rng rng(seed, "synthetic_window", 0);
  SyntheticWindow w;
  BundleProblem& problem = w.problem;
  const int poses = options.fixed_poses + options.free_poses;
  constexpr double step = 0.04;  // rad between neighbours
  for (int i = 0; i < poses; ++i) {
    w.true_poses.push_back(camera_on_arc(step * i));
    const bool fixed = i < options.fixed_poses;
    problem.pose_fixed.push_back(fixed);
    const Vector6d error = random_tangent(rng, options.pose_error_m, options.pose_error_rad);
    problem.poses.push_back(fixed ? w.true_poses[i] : w.true_poses[i].retract(error));
  }
  const int views = std::min(options.views_per_landmark, poses);
  for (int l = 0; l < options.landmarks; ++l) {
    const int first = static_cast<int>(rng.index(static_cast<std::uint32_t>(poses - views + 1)));
    const Se3& middle = w.true_poses[first + views / 2];
    const Eigen::Vector3d point =
        middle *
        problem.intrinsics.unproject(rng.uniform(80, 560), rng.uniform(60, 420), rng.uniform(1.5, 4));
    w.true_landmarks.push_back(point);
    problem.landmarks.push_back(point + options.landmark_error_m *
                                            Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()));
    for (int k = 0; k < views; ++k) {
      ReprojectionObservation o = observe(problem.intrinsics, w.true_poses[first + k], point, options, rng);
      o.pose = first + k;
      o.landmark = l;
      const bool outlier = rng.uniform() < options.outlier_share;
      if (outlier) {
        const double angle = rng.uniform(0, 6.283), length = rng.uniform(30, 80);
        o.u += static_cast<float>(length * std::cos(angle));
        o.v += static_cast<float>(length * std::sin(angle));
      }
      w.planted.push_back(outlier);
      problem.observations.push_back(o);
    }
  }
  return w;
}

// One camera and its matches; the first `outliers` of them are wrong.
struct SyntheticView {
  Se3 world_from_camera;
  std::vector<PoseObservation> observations;
};

inline SyntheticView synthetic_view(int count, int outliers, bool noise = true, std::uint64_t seed = 1,
                                    double depth_share = 0.7) {
  Rng rng(seed, "synthetic_view", 0);
  SyntheticWindowOptions options;
  options.noise = noise;
  options.depth_share = depth_share;
  SyntheticView view{Se3::exp(random_tangent(rng, 1.0, 0.5)), {}};
  const Intrinsics k;
  for (int i = 0; i < count; ++i) {
    PoseObservation match;
    match.point_in_world =
        view.world_from_camera * k.unproject(rng.uniform(20, 620), rng.uniform(20, 460), rng.uniform(0.8, 4));
    const ReprojectionObservation o = observe(k, view.world_from_camera, match.point_in_world, options, rng);
    match.u = o.u, match.v = o.v;
    if (i < outliers) match.u = rng.uniform(20, 620), match.v = rng.uniform(20, 460);
    match.inverse_depth = o.inverse_depth;
    match.inv_sigma_px = o.inv_sigma_px;
    match.inv_sigma_inverse_depth = o.inv_sigma_inverse_depth;
    view.observations.push_back(match);
  }
  return view;
}

}  // namespace vsgraphs
