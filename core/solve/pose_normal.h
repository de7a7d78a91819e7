// Normal equations of the pose-only problem, four observations at a time.
#pragma once

#include <span>
#include <vector>

#include "core/solve/lanes.h"
#include "core/solve/pose_solver.h"
#include "core/solve/reprojection_lanes.h"

namespace vsgraphs {

struct PoseNormal {
  Matrix6d h = Matrix6d::Zero();  // J'J, robustly weighted
  Vector6d b = Vector6d::Zero();  // -J'r
  double cost = 0;                // sum of rho / 2
};

// The observations of one solve, transposed for the lanes. Weights of 0 switch an observation or its depth off.
class PoseRows {
 public:
  PoseRows(const Intrinsics& intrinsics, std::span<const PoseObservation> observations,
           const PoseSolverOptions& options);
  // Adds to `sum` at the given pose.
  void accumulate(const Se3& world_from_camera, PoseNormal& sum) const;
  // Gates every observation, switches the outlying (or their depths) off and the others on. `squares` receives the sum of
  // squared residuals that were kept, `rows` their number.
  void classify_all(const Se3& world_from_camera, std::vector<ObservationFit>& fit, double& squares,
                    int& rows);

 private:
  struct Group {
    Lanes x, y, z;              // points in the world
    ObservationLanes seen;      // weights in use: 0 when switched off
    Lanes full_px, full_depth;  // weights as given
  };
  Intrinsics k_;
  std::size_t count_;
  double delta_px_, delta_depth_;
  std::vector<Group> groups_;
};

}  // namespace vsgraphs
