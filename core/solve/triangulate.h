// A point from two or more views with known poses: linear in the bearings (midpoint of the rays, weighted), then
// Gauss-Newton on the reprojection error, with depth readings where there are any
// (Hartley and Sturm, "Triangulation", CVIU 1997, for the comparison of methods).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/geometry/se3.h"
#include "core/solve/factors/reprojection.h"

namespace vsgraphs {

struct ViewOfPoint {
  Se3 world_from_camera;
  ReprojectionMeasurement measurement;
};

struct TriangulationOptions {
  double min_parallax_rad =
      0.0175;  // largest angle between two rays, 1 deg; not asked where there is a depth reading
  int refinement_steps = 2;
};

// The point in the world, or nothing: fewer than two views and no depth, too little parallax, behind a camera, or a view
// beyond the 95 % gate (pixel and, where given, depth).
std::optional<Eigen::Vector3d> triangulate(const Intrinsics& intrinsics, std::span<const ViewOfPoint> views,
                                           const TriangulationOptions& options = {});

// Angle at the point between the rays to two camera centres, rad.
double parallax_angle(const Eigen::Vector3d& point, const Eigen::Vector3d& centre_a,
                      const Eigen::Vector3d& centre_b);

// Squared whitened pixel error and inverse-depth error (0 without reading) of a point in a view; nothing behind it.
struct ReprojectionError {
  double chi2_px = 0, chi2_depth = 0;
};
std::optional<ReprojectionError> reprojection_error(const Intrinsics& intrinsics,
                                                    const Se3& world_from_camera,
                                                    const Eigen::Vector3d& point,
                                                    const ReprojectionMeasurement& m);

}  // namespace vsgraphs
