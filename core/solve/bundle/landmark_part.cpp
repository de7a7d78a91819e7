#include "core/solve/bundle/landmark_part.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/solve/factors/reprojection.h"

namespace vsgraphs {

LandmarkPart::LandmarkPart(const BundleProblem& problem, const std::vector<int>& variable_of_pose,
                           const BundleOptions& options)
    : k_(problem.intrinsics),
      huber_px_(options.huber_px),
      huber_depth_(options.huber_depth),
      variable_of_pose_(variable_of_pose),
      landmarks_(problem.landmarks.size()),
      inverses_(problem.landmarks.size()) {
  for (int variable : variable_of_pose) free_poses_ = std::max(free_poses_, variable + 1);
  group_observations(problem, variable_of_pose);
  number_edges(problem, variable_of_pose);
}

void LandmarkPart::group_observations(const BundleProblem& problem,
                                      const std::vector<int>& variable_of_pose) {
  std::vector<int> count(variable_of_pose.size(), 0);
  for (const auto& o : problem.observations) ++count[o.pose];
  group_begin_.assign(1, 0);
  for (int n : count) group_begin_.push_back(group_begin_.back() + (n + lane_count - 1) / lane_count);
  Group empty{};
  empty.seen.delta = lanes(1);
  groups_.assign(static_cast<std::size_t>(group_begin_.back()), empty);
  std::vector<int> next(variable_of_pose.size());
  for (std::size_t p = 0; p < next.size(); ++p) next[p] = lane_count * group_begin_[p];
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const ReprojectionObservation& o = problem.observations[i];
    const int at = next[o.pose]++, k = at % lane_count;
    Group& g = groups_[at / lane_count];
    g.seen.u[k] = o.u;
    g.seen.v[k] = o.v;
    g.seen.weight_px[k] = o.inv_sigma_px;
    g.seen.inverse_depth[k] = o.has_depth() ? o.inverse_depth : 0.0f;
    g.seen.weight_depth[k] = o.has_depth() ? o.inv_sigma_inverse_depth : 0.0f;
    g.seen.delta[k] = o.has_depth() ? huber_depth_ : huber_px_;
    g.landmark[k] = o.landmark;
    g.source[k] = static_cast<int>(i);
  }
}

// Poses are walked in ascending order, so a landmark's edges come in ascending order of their variables.
void LandmarkPart::number_edges(const BundleProblem& problem, const std::vector<int>& variable_of_pose) {
  const std::size_t count = problem.landmarks.size();
  std::vector<int> last_pose(count, -1), edges(count, 0);
  const auto walk = [&](auto visit) {  // visit(group, lane, whether this starts a new edge)
    std::fill(last_pose.begin(), last_pose.end(), -1);
    for (std::size_t p = 0; p < variable_of_pose.size(); ++p) {
      if (variable_of_pose[p] < 0) continue;
      for (int g = group_begin_[p]; g < group_begin_[p + 1]; ++g) {
        for (int k = 0; k < lane_count && groups_[g].source[k] >= 0; ++k) {
          int& last = last_pose[groups_[g].landmark[k]];
          visit(groups_[g], k, last != static_cast<int>(p), variable_of_pose[p]);
          last = static_cast<int>(p);
        }
      }
    }
  };
  walk([&](const Group& g, int k, bool starts, int) { edges[g.landmark[k]] += starts; });
  edge_begin_.assign(1, 0);
  pair_begin_.assign(1, 0);
  int longest = 0;
  for (int n : edges) {
    edge_begin_.push_back(edge_begin_.back() + n);
    pair_begin_.push_back(pair_begin_.back() + n * (n + 1) / 2);
    longest = std::max(longest, n);
  }
  edges_.resize(static_cast<std::size_t>(edge_begin_.back()));
  edge_variable_.resize(edges_.size());
  std::vector<int> next(edge_begin_.begin(), edge_begin_.end() - 1);
  walk([&](Group& g, int k, bool starts, int variable) {
    int& at = next[g.landmark[k]];
    if (starts) edge_variable_[at++] = variable;
    g.edge[k] = at - 1;
  });
  tall_.resize(static_cast<std::size_t>(longest));
}

void LandmarkPart::add_pairs(std::vector<std::vector<int>>& rows) const {
  // Landmarks seen by each pose, so that each column is finished before the next and one row of marks suffices.
  std::vector<int> begin(static_cast<std::size_t>(free_poses_) + 1, 0);
  for (int variable : edge_variable_) ++begin[variable + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::pair<int, int>> seen(edges_.size());  // edge, one past its landmark's last edge
  std::vector<int> next = begin;
  for (std::size_t l = 0; l < landmarks_.size(); ++l) {
    for (int e = edge_begin_[l]; e < edge_begin_[l + 1]; ++e)
      seen[next[edge_variable_[e]]++] = {e, edge_begin_[l + 1]};
  }
  std::vector<int> mark(static_cast<std::size_t>(free_poses_), -1);
  for (int c = 0; c < free_poses_; ++c) {
    for (int s = begin[c]; s < begin[c + 1]; ++s) {
      for (int e = seen[s].first + 1; e < seen[s].second; ++e) {
        const int r = edge_variable_[e];
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
  pair_value_.resize(static_cast<std::size_t>(pair_begin_.back()));
  std::size_t at = 0;
  for (std::size_t l = 0; l < landmarks_.size(); ++l) {
    for (int i = edge_begin_[l]; i < edge_begin_[l + 1]; ++i) {
      for (int j = i; j < edge_begin_[l + 1]; ++j) {
        pair_value_[at++] = pattern.value_begin(pattern.find(edge_variable_[j], edge_variable_[i]));
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
  for (Group& g : groups_) {
    for (int k = 0; k < lane_count && g.source[k] >= 0; ++k) {
      const ObservationFit f = fit[g.source[k]];
      if (f == ObservationFit::inlier) continue;
      g.seen.inverse_depth[k] = 0;
      g.seen.weight_depth[k] = 0;
      g.seen.delta[k] = huber_px_;
      if (f == ObservationFit::outlier) g.seen.weight_px[k] = 0;
    }
  }
}

}  // namespace vsgraphs
