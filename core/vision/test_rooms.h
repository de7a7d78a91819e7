// Depth images of rooms made of planes, exact to the float: for tests of what works on surfaces.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/se3.h"
#include "core/vision/depth_lookup.h"

namespace vsgraphs::test {

// normal . x = offset_m; the normal points at the wall's outside.
struct Wall {
  Eigen::Vector3d normal;
  double offset_m;
};

// Seen from inside a convex room, the nearest plane in front is what a ray meets. Rays that meet none give 0.
inline Image<float> depth_of_room(const Camera& camera, const Se3& world_from_camera,
                                  const std::vector<Wall>& walls) {
  Image<float> depth(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      Eigen::Vector2d pixel(u, v);
      if (camera.distorted()) pixel = camera.undistort(pixel);
      const Eigen::Vector3d ray = world_from_camera.rotation() * camera.unproject(pixel.x(), pixel.y(), 1.0);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Wall& wall : walls) {
        const double speed = wall.normal.dot(ray);
        if (speed <= 0) continue;
        nearest =
            std::min(nearest, (wall.offset_m - wall.normal.dot(world_from_camera.translation())) / speed);
      }
      depth.at(u, v) = nearest <= camera.depth_max_m ? static_cast<float>(nearest) : 0.0F;
    }
  }
  return depth;
}

inline DepthView view_of(const Image<float>& depth) {
  DepthView view;
  view.metres = depth.view();
  return view;
}

// Seen from the origin towards +z: a floor, a wall ahead, a wall to the right; none is square to another.
inline std::vector<Wall> corner_room() {
  return {{Eigen::Vector3d(0, 1, 0), 0.6},
          {Eigen::Vector3d(-0.3, 0, 1).normalized(), 2.5},
          {Eigen::Vector3d(1, 0.1, 0.2).normalized(), 0.7}};
}

// 1.6 m wide, 1.2 m high, without end along z.
inline std::vector<Wall> corridor() {
  return {{Eigen::Vector3d(0, 1, 0), 0.6},
          {Eigen::Vector3d(0, -1, 0), 0.6},
          {Eigen::Vector3d(1, 0, 0), 0.8},
          {Eigen::Vector3d(-1, 0, 0), 0.8}};
}

}  // namespace vsgraphs::test
