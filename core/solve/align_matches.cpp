#include "core/solve/align_matches.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/geometry/align.h"
#include "core/solve/factors/reprojection.h"
#include "core/solve/pose_normal.h"

namespace vsgraphs {
namespace {

class Ransac {
 public:
  Ransac(const Intrinsics& k, std::span<const PoseObservation> matches, const AlignMatchesOptions& options)
      : k_(k), matches_(matches), options_(options) {
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (matches[i].has_depth()) drawable_.push_back(i);
    }
  }

  std::optional<Se3> run(Rng& rng) {
    if (drawable_.size() < 3) return {};
    std::optional<Se3> best;
    int best_count = 0;
    double needed = options_.max_hypotheses;
    for (int i = 0; i < options_.max_hypotheses && i < needed; ++i) {
      const auto pose = draw(rng);
      if (!pose) continue;
      const int count = support(*pose, best_count);
      if (count <= best_count) continue;
      best_count = count;
      best = pose;
      const double share = std::min(1.0 - 1e-9, count / static_cast<double>(matches_.size()));
      needed = std::log(1 - options_.confidence) / std::log1p(-share * share * share);
    }
    return best;
  }

  // The matches that agree with a pose within the inflated gate.
  std::vector<PoseObservation> supporters(const Se3& pose) const {
    const Eigen::Matrix3d camera_from_world = pose.rotation().transpose();
    std::vector<PoseObservation> out;
    for (const PoseObservation& m : matches_) {
      if (agrees(m, camera_from_world, pose)) out.push_back(m);
    }
    return out;
  }

 private:
  std::optional<Se3> draw(Rng& rng) const {
    const auto n = static_cast<std::uint32_t>(drawable_.size());
    std::array<std::uint32_t, 3> pick{rng.index(n), rng.index(n - 1), rng.index(n - 2)};
    if (pick[1] >= pick[0]) ++pick[1];  // distinct without redrawing
    const auto [low, high] = std::minmax(pick[0], pick[1]);
    if (pick[2] >= low) ++pick[2];
    if (pick[2] >= high) ++pick[2];
    std::array<PoseObservation, 3> sample;
    std::array<Eigen::Vector3d, 3> world, camera;
    for (int i = 0; i < 3; ++i) {
      const PoseObservation& m = sample[i] = matches_[drawable_[pick[i]]];
      world[i] = m.point_in_world;
      camera[i] = k_.unproject(m.u, m.v, 1.0 / m.inverse_depth);
    }
    // Triangles that differ in a side by more than the readings allow hold a wrong match: most hypotheses end here.
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double a = (world[i] - world[j]).norm(), b = (camera[i] - camera[j]).norm();
      if (std::min(a, b) < 0.05 || std::abs(a - b) > 0.08 + 0.1 * std::max(a, b)) return {};
    }
    const std::optional<Se3> pose = align_points(world, camera);
    return pose ? sharpened(sample, *pose) : pose;
  }

  // Depth readings place three points to centimetres, which is many pixels; their pixels know better.
  std::optional<Se3> sharpened(const std::array<PoseObservation, 3>& sample, Se3 pose) const {
    PoseSolverOptions plain;
    plain.huber_px = plain.huber_depth = 1e6;
    const PoseRows rows(k_, sample, plain);
    for (int step = 0; step < 2; ++step) {
      PoseNormal normal;
      rows.accumulate(pose, normal);
      normal.h.diagonal() *= 1 + 1e-9;
      const Vector6d xi = normal.h.llt().solve(normal.b);
      if (!xi.allFinite()) return {};
      pose = pose.retract(xi);
    }
    return pose;
  }

  bool agrees(const PoseObservation& m, const Eigen::Matrix3d& camera_from_world, const Se3& pose) const {
    const Eigen::Vector3d p = camera_from_world * (m.point_in_world - pose.translation());
    if (!(p.z() >= min_projection_depth_m)) return false;
    const double iz = 1.0 / p.z();
    const double ru = (k_.fx * p.x() * iz + k_.cx - m.u) * m.inv_sigma_px;
    const double rv = (k_.fy * p.y() * iz + k_.cy - m.v) * m.inv_sigma_px;
    const double rd = m.has_depth() ? (iz - m.inverse_depth) * m.inv_sigma_inverse_depth : 0.0;
    return ru * ru + rv * rv + rd * rd <= options_.gate_inflation * (m.has_depth() ? chi2_95_3 : chi2_95_2);
  }

  // Matches within the inflated gate; gives up once `to_beat` is out of reach.
  int support(const Se3& pose, int to_beat) const {
    const Eigen::Matrix3d camera_from_world = pose.rotation().transpose();
    int count = 0, left = static_cast<int>(matches_.size());
    for (const PoseObservation& m : matches_) {
      if (count + left <= to_beat) break;
      --left;
      count += agrees(m, camera_from_world, pose);
    }
    return count;
  }

  const Intrinsics& k_;
  std::span<const PoseObservation> matches_;
  const AlignMatchesOptions& options_;
  std::vector<std::size_t> drawable_;
};

}  // namespace

std::optional<PoseSolution> align_matches(const Intrinsics& intrinsics,
                                          std::span<const PoseObservation> matches, Rng rng,
                                          const AlignMatchesOptions& options) {
  Ransac ransac(intrinsics, matches, options);
  const std::optional<Se3> pose = ransac.run(rng);
  if (!pose) return {};
  // First on what agreed with the three, so that the many wrong matches have no say; then everything is judged anew.
  const Se3 refined = solve_pose(intrinsics, *pose, ransac.supporters(*pose)).world_from_camera;
  PoseSolverOptions gated;
  gated.gate_first = true;
  PoseSolution solution = solve_pose(intrinsics, refined, matches, {}, {}, gated);
  if (solution.inliers < options.min_inliers || !solution.world_from_camera.finite()) return {};
  return solution;
}

}  // namespace vsgraphs
