// What constant velocity is worth as a measurement.
#pragma once

#include "core/geometry/se3.h"
#include "core/solve/pose_solver.h"

namespace vsgraphs {

// A prediction (world_from_camera) over `seconds`: it fails by accelerations, which grow with the time between frames. Information
// of (rho, phi) on the right of the pose: 1 / (0.02 + 0.3 t)^2, per m^2 and rad^2.
inline PosePriorTerm motion_prior(const Se3& predicted, double seconds) {
  const double sigma_m = 0.02 + 0.3 * seconds, sigma_rad = 0.02 + 0.3 * seconds;
  PosePriorTerm prior;
  prior.world_from_camera = predicted;
  prior.information.diagonal().head<3>().setConstant(1.0 / (sigma_m * sigma_m));
  prior.information.diagonal().tail<3>().setConstant(1.0 / (sigma_rad * sigma_rad));
  return prior;
}

}  // namespace vsgraphs
