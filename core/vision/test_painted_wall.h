// A scene whose truth needs no renderer, for tests of tracking and of whole runs: a long wall covered with rectangles of all
// sizes. A camera that slides along it sees its image shifted by whole pixels.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/image.h"
#include "core/base/rng.h"
#include "core/geometry/camera.h"

namespace vsgraphs::test {

inline constexpr int painted_view_width = 320, painted_view_height = 240;
inline constexpr double painted_view_focal_px = 262.5;

inline Camera painted_wall_camera(double fps) {
  Camera camera;
  camera.width = painted_view_width;
  camera.height = painted_view_height;
  camera.fx = camera.fy = painted_view_focal_px;
  camera.cx = 159.5;
  camera.cy = 119.5;
  camera.fps = fps;
  return camera;
}

inline Image<std::uint8_t> painted_wall(int width, int rectangles, Rng rng) {
  constexpr int height = painted_view_height;
  Image<std::uint8_t> wall(width, height, 128);
  for (int i = 0; i < rectangles; ++i) {
    const int u0 = static_cast<int>(rng.index(static_cast<std::uint32_t>(width)));
    const int v0 = static_cast<int>(rng.index(height));
    const int u1 = std::min(width, u0 + 4 + static_cast<int>(rng.index(24)));
    const int v1 = std::min(height, v0 + 4 + static_cast<int>(rng.index(24)));
    const auto grey = static_cast<std::uint8_t>(20 + rng.index(216));
    for (int v = v0; v < v1; ++v) std::fill(&wall.at(u0, v), &wall.at(u1 - 1, v) + 1, grey);
  }
  return wall;
}

}  // namespace vsgraphs::test
