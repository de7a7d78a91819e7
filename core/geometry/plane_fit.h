// Weighted least squares fit of a plane to points, condensed to the plane and its information: what thousands of depth
// readings say, in nine numbers. Exact to second order around the fit.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/geometry/camera.h"
#include "core/geometry/plane_estimate.h"

namespace vsgraphs {

// What adds to the depth sensor's own noise in a plane's points.
struct SurfaceNoise {
  double pixel_px =
      0.5;  // where in its pixel a reading was taken: all that is left of the noise at grazing angles
  double model_m = 0.003;  // real surfaces are not flat, calibrations not exact; keeps sigma above 0
};

// Standard deviation, in m along the unit `normal`, of a point measured by `camera` (camera frame, z > 0): depth noise
// acts along the ray, pixel noise across the image, the model's floor along the normal.
double normal_sigma_m(const Camera& camera, const SurfaceNoise& noise, const Eigen::Vector3d& point,
                      const Eigen::Vector3d& normal);

// Readings of one depth image are correlated and landmarks use the same depth: information grows with the points only up
// to this many independent ones.
inline constexpr double default_effective_count = 30;

struct PlaneFit {
  PlaneEstimate estimate;  // anchored at the weighted centroid, normal towards the viewpoint
  double rms_m = 0;        // weighted root mean square distance of the points
};

// Weighted sums over points, enough to fit a plane; sums of pieces merge by addition, in any frame as long as it is one.
class PlaneSums {
 public:
  // weight = 1 / sigma^2, in 1/m^2; see normal_sigma_m.
  void add(const Eigen::Vector3d& point, double weight);
  PlaneSums& operator+=(const PlaneSums& other);

  int count() const { return count_; }
  double weight() const { return weight_; }
  // Of a plane that need not be the fit: root of the weighted mean of its squared distances, m. Needs weight() > 0.
  double rms_m(const AnchoredPlane& plane) const;

  // Empty for fewer than three points, no weight, values that are not finite and points exactly on a line. The weights'
  // scale enters the information only, so sigma_n may come from a rough normal. `viewpoint`: the normal turns towards
  // it. `effective_count` 0 or less: all points are independent.
  std::optional<PlaneFit> fit(double effective_count = default_effective_count,
                              const Eigen::Vector3d& viewpoint = Eigen::Vector3d::Zero()) const;

 private:
  int count_ = 0;
  double weight_ = 0;                                 // sum of w
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();   // sum of w x
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();  // sum of w x x'
};

}  // namespace vsgraphs
