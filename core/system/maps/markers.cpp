#include "core/system/maps/markers.h"

#include <cmath>
#include <string>

#include "core/base/check.h"
#include "core/geometry/principal_axes.h"

namespace vsgraphs {
namespace {

bool is_rigid(const Se3& pose) {
  const Eigen::Matrix3d& r = pose.rotation();
  constexpr double rounding = 1e-6;
  return pose.translation().allFinite() && r.allFinite() &&
         (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < rounding &&
         r.determinant() > 0;
}

// Sigmas from a tenth of a micrometre (or microradian): below, its inverse swamps everything else.
bool is_covariance(const Matrix6d& c) {
  constexpr double least = 1e-14;
  if (!c.allFinite() || (c - c.transpose()).cwiseAbs().maxCoeff() > 1e-9 * c.cwiseAbs().maxCoeff())
    return false;
  return smallest_eigenvalue6(c) >= least;
}

}  // namespace

void check_markers(const MarkerDetections& detections) {
  for (const MarkerDetection& d : detections) {
    const std::string marker = "marker " + std::to_string(d.id.number) + ": ";
    require_input(std::isfinite(d.size_m) && d.size_m > 0, marker + "its size must be positive");
    require_input(is_rigid(d.camera_from_marker), marker + "its pose is no finite rigid transform");
    require_input(is_covariance(d.covariance),
                  marker + "its covariance must be finite, symmetric and positive definite");
  }
}

}  // namespace vsgraphs
