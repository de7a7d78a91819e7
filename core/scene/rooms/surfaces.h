// What recognition of rooms is told about mapped planes: classified surfaces in the levelled frame (z up, metres).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/plane.h"
#include "core/map/ids.h"

namespace vsgraphs {

// One face of a wall, a ground or a ceiling, with where it was seen. Points lie on the surface within noise, about one
// per voxel of 0.05-0.15 m. Walls look into the room, grounds up, ceilings down.
struct SceneFace {
  PlaneId id;
  AnchoredPlane plane;
  std::vector<Eigen::Vector3f> points;
};

struct SceneFaces {
  std::vector<SceneFace> walls, grounds, ceilings;
};

}  // namespace vsgraphs
