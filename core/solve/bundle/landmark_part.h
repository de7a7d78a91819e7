// The reprojection side of the joint problem: landmark-major observations, their normal equations, and the elimination
// of every landmark from the reduced system (fixed-size blocks, lower half only).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/solve/bundle/block_matrix.h"
#include "core/solve/bundle_adjustment.h"

namespace vsgraphs {

class LandmarkPart {
 public:
  // variable_of_pose: place of each free pose in the reduced system (ascending with the pose's index), -1 if fixed.
  LandmarkPart(const BundleProblem& problem, const std::vector<int>& variable_of_pose, const BundleOptions& options);

  // Appends to rows[c] the free poses r > c that share a landmark with c (unsorted, each once).
  void add_pairs(std::vector<std::vector<int>>& rows) const;
  // Call once the pattern holds those pairs.
  void bind(const BlockMatrix& pattern);

  // Sum of rho / 2.
  double cost(const std::vector<Se3>& poses, const std::vector<Eigen::Vector3d>& landmarks) const;
  // Normal equations at the given state: adds to the diagonal blocks of `values` and to `b` = -gradient.
  void linearise(const std::vector<Se3>& poses, const std::vector<Eigen::Vector3d>& landmarks, double* values,
                 Eigen::VectorXd& b);
  // Subtracts from the damped `values` and from `b` what the landmarks explain.
  void eliminate(double lambda, double* values, Eigen::VectorXd& b);
  // Given the reduced step, writes landmarks + step and returns the decrease the model predicts for the landmarks' part.
  double back_substitute(double lambda, const Eigen::VectorXd& step, const std::vector<Eigen::Vector3d>& landmarks,
                         std::vector<Eigen::Vector3d>& moved) const;

  // The 95 % gate at the given state, from the measurements as they came, in the caller's order.
  std::vector<ObservationFit> classify_all(const std::vector<Se3>& poses,
                                           const std::vector<Eigen::Vector3d>& landmarks,
                                           const std::vector<ReprojectionObservation>& observations) const;
  // Gives outliers no weight from here on, and demoted depths neither.
  void drop(const std::vector<ObservationFit>& fit);

 private:
  struct Observation {
    float u, v, inverse_depth, inv_sigma_px, inv_sigma_inverse_depth;  // inv_sigma_px 0: dropped
    int pose;
    int edge;  // -1: the pose is fixed
    int source;
  };
  // A landmark seen from one free pose; several observations may share it.
  struct Edge {
    int variable;
    alignas(16) std::array<double, 18> w;  // 6x3 column-major, J_pose' J_point
  };
  struct Landmark {
    int observation_begin, edge_begin, pair_begin;
    std::array<double, 6> h;        // J_point' J_point: 00 10 20 11 21 22
    std::array<double, 6> inverse;  // of the damped h
    std::array<double, 3> b;        // -gradient
  };
  struct Pose {
    std::array<double, 21> h;  // lower triangle, by columns
    std::array<double, 6> b;
  };

  void sort_observations(const BundleProblem& problem, const std::vector<int>& variable_of_pose);
  void linearise_landmark(std::size_t l, const std::vector<Se3>& poses, const Eigen::Vector3d& point);
  double robust_delta(const Observation& o) const { return o.inverse_depth > 0 ? huber_depth_ : huber_px_; }

  Intrinsics k_;
  double huber_px_, huber_depth_;
  int free_poses_ = 0;
  std::vector<Observation> observations_;  // by landmark, then pose, then input order
  std::vector<Landmark> landmarks_;        // one past the end too
  std::vector<Edge> edges_;                // by landmark, then variable
  std::vector<Pose> pose_sums_;            // per free pose
  std::vector<int> pair_value_;            // per landmark, per edge i, per edge j >= i: where block (j, i) begins
  std::vector<int> diagonal_value_;        // per free pose
  struct EdgeLanes;
  int longest_ = 0;  // most edges of one landmark
};

}  // namespace vsgraphs
