// A frame's depth laid against the planes of the map: walls and ground hold a pose where corners are rare, and hold it to
// the map rather than to a neighbour's depth, so that errors do not add up along a bare corridor. Point-to-plane
// (Chen and Medioni 1991) with mapped planes as in planar SLAM (Salas-Moreno et al., "Dense Planar SLAM", ISMAR 2014).
#pragma once

#include <vector>

#include "core/geometry/camera.h"
#include "core/map/map.h"
#include "core/solve/factors/point_to_plane.h"

namespace vsgraphs {

// Rows for every other sample that lies, at `world_from_camera`, within `gate_m` of a plane seen by at least
// three keyframes and faces its way. All rows on one plane together count as `effective` independent ones, each as
// uncertain as what a whole frame's depth has in common. About 0.1 ms for 20 planes.
// `used`: receives 1 for each sample of the grid that got a row; may be null.
std::vector<PointToPlane> rows_on_planes(const Map& map, const DepthGrid& now, const Se3& world_from_camera,
                                         double gate_m, const DepthNoise& noise,
                                         std::vector<std::uint8_t>* used = nullptr);

}  // namespace vsgraphs
