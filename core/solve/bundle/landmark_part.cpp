#include "core/solve/bundle/landmark_part.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/solve/factors/reprojection.h"

namespace vsgraphs {

LandmarkPart::LandmarkPart(const BundleProblem& problem, const std::vector<int>& variable_of_pose,
                           const BundleOptions& options)
    : k_(problem.intrinsics), huber_px_(options.huber_px), huber_depth_(options.huber_depth) {
  for (int variable : variable_of_pose) free_poses_ = std::max(free_poses_, variable + 1);
  pose_sums_.resize(static_cast<std::size_t>(free_poses_));
  sort_observations(problem, variable_of_pose);
}

void LandmarkPart::sort_observations(const BundleProblem& problem, const std::vector<int>& variable_of_pose) {
  const auto& input = problem.observations;
  landmarks_.resize(problem.landmarks.size() + 1);
  std::vector<int> next(problem.landmarks.size() + 1, 0);
  for (const auto& o : input) ++next[o.landmark + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t l = 0; l < landmarks_.size(); ++l) landmarks_[l].observation_begin = next[l];
  observations_.resize(input.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    const auto& o = input[i];
    observations_[next[o.landmark]++] = {o.u, o.v, std::max(o.inverse_depth, 0.0f), o.inv_sigma_px,
                                         o.inverse_depth > 0 ? o.inv_sigma_inverse_depth : 0.0f, o.pose, -1,
                                         static_cast<int>(i)};
  }
  edges_.reserve(input.size());
  int pairs = 0;
  for (std::size_t l = 0; l + 1 < landmarks_.size(); ++l) {
    const auto first = observations_.begin() + landmarks_[l].observation_begin;
    const auto last = observations_.begin() + landmarks_[l + 1].observation_begin;
    std::sort(first, last, [](const Observation& a, const Observation& b) {
      return a.pose != b.pose ? a.pose < b.pose : a.source < b.source;
    });
    landmarks_[l].edge_begin = static_cast<int>(edges_.size());
    landmarks_[l].pair_begin = pairs;
    for (auto o = first; o != last; ++o) {
      const int variable = variable_of_pose[o->pose];
      if (variable < 0) continue;
      const bool same = static_cast<int>(edges_.size()) > landmarks_[l].edge_begin && edges_.back().variable == variable;
      if (!same) edges_.push_back({variable, {}});
      o->edge = static_cast<int>(edges_.size()) - 1;
    }
    const int k = static_cast<int>(edges_.size()) - landmarks_[l].edge_begin;
    longest_ = std::max(longest_, k);
    pairs += k * (k + 1) / 2;
  }
  landmarks_.back().edge_begin = static_cast<int>(edges_.size());
  landmarks_.back().pair_begin = pairs;
}

void LandmarkPart::add_pairs(std::vector<std::vector<int>>& rows) const {
  // Landmarks seen by each pose, so that each column is finished before the next and one row of marks suffices.
  std::vector<int> begin(static_cast<std::size_t>(free_poses_) + 1, 0);
  for (const Edge& e : edges_) ++begin[e.variable + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::pair<int, int>> seen(edges_.size());  // edge, one past its landmark's last edge
  std::vector<int> next = begin;
  for (std::size_t l = 0; l + 1 < landmarks_.size(); ++l) {
    for (int e = landmarks_[l].edge_begin; e < landmarks_[l + 1].edge_begin; ++e) {
      seen[next[edges_[e].variable]++] = {e, landmarks_[l + 1].edge_begin};
    }
  }
  std::vector<int> mark(static_cast<std::size_t>(free_poses_), -1);
  for (int c = 0; c < free_poses_; ++c) {
    for (int s = begin[c]; s < begin[c + 1]; ++s) {
      for (int e = seen[s].first + 1; e < seen[s].second; ++e) {
        const int r = edges_[e].variable;
        if (mark[r] == c) continue;
        mark[r] = c;
        rows[c].push_back(r);
      }
    }
  }
}

void LandmarkPart::bind(const BlockMatrix& pattern) {
  diagonal_value_.resize(static_cast<std::size_t>(free_poses_));
  for (int v = 0; v < free_poses_; ++v) diagonal_value_[v] = pattern.value_begin(pattern.diagonal(v));
  pair_value_.resize(static_cast<std::size_t>(landmarks_.back().pair_begin));
  std::size_t at = 0;
  for (std::size_t l = 0; l + 1 < landmarks_.size(); ++l) {
    const int end = landmarks_[l + 1].edge_begin;
    for (int i = landmarks_[l].edge_begin; i < end; ++i) {
      for (int j = i; j < end; ++j) {
        pair_value_[at++] = pattern.value_begin(pattern.find(edges_[j].variable, edges_[i].variable));
      }
    }
  }
}

std::vector<ObservationFit> LandmarkPart::classify_all(
    const std::vector<Se3>& poses, const std::vector<Eigen::Vector3d>& landmarks,
    const std::vector<ReprojectionObservation>& observations) const {
  std::vector<ObservationFit> fit;
  fit.reserve(observations.size());
  for (const auto& o : observations) {
    const Se3& pose = poses[o.pose];
    const Eigen::Vector3d p = pose.rotation().transpose() * (landmarks[o.landmark] - pose.translation());
    if (!(p.z() >= min_projection_depth_m)) {
      fit.push_back(ObservationFit::outlier);
      continue;
    }
    const Eigen::Vector2d error = (k_.project(p) - Eigen::Vector2d(o.u, o.v)) * o.inv_sigma_px;
    const double depth_error = (1.0 / p.z() - o.inverse_depth) * o.inv_sigma_inverse_depth;
    fit.push_back(classify(error.squaredNorm(), depth_error * depth_error, o.has_depth()));
  }
  return fit;
}

void LandmarkPart::drop(const std::vector<ObservationFit>& fit) {
  for (Observation& o : observations_) {
    const ObservationFit f = fit[o.source];
    if (f == ObservationFit::inlier) continue;
    o.inverse_depth = 0;
    o.inv_sigma_inverse_depth = 0;
    if (f == ObservationFit::outlier) o.inv_sigma_px = 0;
  }
}

}  // namespace vsgraphs
