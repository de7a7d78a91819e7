// The reprojection side of the joint problem: the normal equations of all observations and the elimination of every landmark
// from the reduced system. Observations are read by pose, four at a time; blocks have fixed sizes, lower half only.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/solve/bundle/block_matrix.h"
#include "core/solve/bundle_adjustment.h"
#include "core/solve/reprojection_lanes.h"

namespace vsgraphs {

class LandmarkPart {
 public:
  // variable_of_pose: place of each free pose in the reduced system (ascending with the pose's index), -1 if fixed.
  LandmarkPart(const BundleProblem& problem, const std::vector<int>& variable_of_pose,
               const BundleOptions& options);

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
  double back_substitute(double lambda, const Eigen::VectorXd& step,
                         const std::vector<Eigen::Vector3d>& landmarks,
                         std::vector<Eigen::Vector3d>& moved) const;

  // The 95 % gate at the given state, from the measurements as they came, in the caller's order.
  std::vector<ObservationFit> classify_all(const std::vector<Se3>& poses,
                                           const std::vector<Eigen::Vector3d>& landmarks,
                                           const std::vector<ReprojectionObservation>& observations) const;
  // Gives outliers no weight from here on, and demoted depths neither.
  void drop(const std::vector<ObservationFit>& fit);

 private:
  // Four observations of one pose; lanes that are padding or dropped have weight_px 0.
  struct Group {
    ObservationLanes seen;
    std::array<int, lane_count> landmark{}, source{-1, -1, -1, -1};  // source: the caller's index
    std::array<int, lane_count> edge{-1, -1, -1, -1};                // -1: padding, or the pose is fixed
  };
  // A landmark seen from one free pose; several observations may share it. J_pose' J_point = -[N; p x N] with N = M R', M
  // the point's information in the camera frame, and p the point in the camera.
  struct Edge {
    std::array<double, 12> values{};  // N column-major, p
    Eigen::Map<const Eigen::Matrix3d> n() const { return Eigen::Map<const Eigen::Matrix3d>(values.data()); }
    Eigen::Map<const Eigen::Vector3d> p() const {
      return Eigen::Map<const Eigen::Vector3d>(values.data() + 9);
    }
  };
  struct Landmark {
    std::array<double, 12> values{};  // J_point' J_point: 00 10 20 11 21 22; -gradient; padding
    const double* h() const { return values.data(); }
    Eigen::Map<const Eigen::Vector3d> b() const {
      return Eigen::Map<const Eigen::Vector3d>(values.data() + 6);
    }
  };
  // Rows 0-3, rows 4 5 0 1 and rows 2-5 of each column of a 6x3 block: two columns of a 6x6 product, one after the other in
  // memory, are then three full registers.
  struct Tall {
    Lanes top[3], middle[3], bottom[3];
  };

  void group_observations(const BundleProblem& problem, const std::vector<int>& variable_of_pose);
  void number_edges(const BundleProblem& problem, const std::vector<int>& variable_of_pose);
  ProjectionLanes project_group(const Group& group, const Se3& pose,
                                const std::vector<Eigen::Vector3d>& landmarks) const;
  void add_to_points(const Group& group, const Se3& pose, const ProjectionLanes& q,
                     const PointInformation& info);
  void prepare_edges(std::size_t l, const std::array<double, 6>& inverse, Eigen::VectorXd& b);
  const int* subtract_column(const Edge& edge, int i, int edges, const int* pair, double* values) const;

  Intrinsics k_;
  double huber_px_, huber_depth_;
  int free_poses_ = 0;
  std::vector<int> variable_of_pose_;
  std::vector<int> group_begin_;  // per pose, one past the end too
  std::vector<Group> groups_;
  std::vector<Landmark> landmarks_;
  std::vector<std::array<double, 6>> inverses_;  // of the damped h, per landmark
  std::vector<int> edge_begin_, pair_begin_;     // per landmark, one past the end too
  std::vector<Edge> edges_;                      // by landmark, then variable
  std::vector<int> edge_variable_;
  std::vector<int> pair_value_;      // per landmark, per edge i, per edge j >= i: where block (j, i) begins
  std::vector<int> diagonal_value_;  // per free pose
  std::vector<Tall> tall_;           // room for the most edges of one landmark
};

}  // namespace vsgraphs
