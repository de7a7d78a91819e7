// Point to plane: a point measured in the camera lies on a plane n.x + d = 0 of the world.
// residual = (n . (T p_c) + d) / sigma; pose perturbed on the right (Chen and Medioni 1991 for the error metric).
#pragma once

#include <Eigen/Core>

#include "core/geometry/se3.h"

namespace vsgraphs {

struct PointToPlane {
  Eigen::Vector3d point_in_camera = Eigen::Vector3d::Zero();   // m
  Eigen::Vector3d normal_in_world = Eigen::Vector3d::UnitZ();  // unit
  double offset_m = 0;                                         // d
  double inv_sigma = 1;                                        // 1/m, along the normal
};

// Returns the whitened residual; `by_pose` (may be null) receives its 1x6 Jacobian as a column.
inline double point_to_plane(const Se3& world_from_camera, const PointToPlane& m, Vector6d* by_pose) {
  const double distance = m.normal_in_world.dot(world_from_camera * m.point_in_camera) + m.offset_m;
  if (by_pose) {
    const Eigen::Vector3d normal_in_camera = world_from_camera.rotation().transpose() * m.normal_in_world;
    by_pose->head<3>() = m.inv_sigma * normal_in_camera;
    by_pose->tail<3>() = m.inv_sigma * m.point_in_camera.cross(normal_in_camera);
  }
  return m.inv_sigma * distance;
}

}  // namespace vsgraphs
