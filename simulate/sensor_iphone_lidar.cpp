// A telephone's LiDAR as its system hands it out: 256 x 192, dense, smooth. Luetzenburg, Kroon and Bjoerk, "Evaluation of the Apple iPhone 12
// Pro LiDAR for an application in geosciences" (Scientific Reports 11, 2021): 1 cm for things of a hand's size and more, range 5 m, edges of
// small things washed out; Vogt, Rips and Emmelmann, "Comparison of iPad Pro's LiDAR and TrueDepth capabilities with an industrial 3D
// scanning solution" (Technologies 9, 2021).
#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/depth_sensors.h"

namespace vsgraphs {
namespace {

constexpr int columns = 256;
constexpr float near_sigma_m = 0.002f,
                far_sigma = 0.0025f;  // of lumps some cells wide: metres, and of the distance
constexpr std::array<float, 5> smooth{0.08f, 0.25f, 0.34f, 0.25f, 0.08f};  // about a cell and a half wide
constexpr GlassAnswer glass{0.25f, 0.0f, 12, 0.5f, 0.0f, 0.1f};

// One pass of smoothing along rows, the image turned on the way: twice, and it is smoothed both ways. Empty cells do not count.
Image<float> smoothed_and_turned(const Image<float>& in) {
  Image<float> out(in.height, in.width);
  for (int v = 0; v < in.height; ++v) {
    for (int u = 0; u < in.width; ++u) {
      float sum = 0, weight = 0;
      for (int k = -2; k <= 2; ++k) {
        const float z = in.at(std::clamp(u + k, 0, in.width - 1), v);
        const float share = z > 0 ? smooth[static_cast<std::size_t>(k + 2)] : 0.0f;
        sum += share * z, weight += share;
      }
      out.at(v, u) = weight > 0.3f ? sum / weight : 0.0f;
    }
  }
  return out;
}

// Depth in cells of the sensor's own grid, exact at their middles.
Image<float> cells_of(const Image<float>& depth_m) {
  const int w = std::min(columns, depth_m.width), h = std::max(1, depth_m.height * w / depth_m.width);
  Image<float> out(w, h);
  for (int v = 0; v < h; ++v)
    for (int u = 0; u < w; ++u)
      out.at(u, v) =
          depth_m.at((2 * u + 1) * depth_m.width / (2 * w), (2 * v + 1) * depth_m.height / (2 * h));
  return out;
}

float blended(const Image<float>& cells, float x, float y) {
  const float cx = std::clamp(x, 0.0f, static_cast<float>(cells.width - 1)),
              cy = std::clamp(y, 0.0f, static_cast<float>(cells.height - 1));
  const int u = std::min(static_cast<int>(cx), std::max(0, cells.width - 2)),
            v = std::min(static_cast<int>(cy), std::max(0, cells.height - 2));
  const int u1 = std::min(u + 1, cells.width - 1), v1 = std::min(v + 1, cells.height - 1);
  const float fx = cx - static_cast<float>(u), fy = cy - static_cast<float>(v);
  const float a = cells.at(u, v), b = cells.at(u1, v), c = cells.at(u, v1), d = cells.at(u1, v1);
  if (a <= 0 || b <= 0 || c <= 0 || d <= 0) return 0;
  return (1 - fy) * ((1 - fx) * a + fx * b) + fy * ((1 - fx) * c + fx * d);
}

}  // namespace

Image<std::uint16_t> sense_iphone_lidar(const NoiseOptions& noise, const Camera& camera, int frame,
                                        const ExactDepth& view) {
  Rng rng(noise.seed, "iphone_lidar", static_cast<std::uint64_t>(frame));
  Image<float> cells = cells_of(look_through(view, camera, glass, rng).depth_m);
  if (noise.depth_quantisation) cells = smoothed_and_turned(smoothed_and_turned(cells));
  SmoothNoise lumps(rng, cells.width, cells.height, 10, Drawn::bell),
      grain(rng, cells.width, cells.height, 2, Drawn::bell);
  for (int v = 0; v < cells.height; ++v) {
    lumps.select_row(v), grain.select_row(v);
    for (int u = 0; u < cells.width; ++u) {
      float& z = cells.at(u, v);
      if (noise.depth_quantisation && z > 0)
        z += (near_sigma_m + far_sigma * z) * blend_gain * (lumps.at(u) + 0.2f * grain.at(u));
      if (noise.depth_holes && (z < noise.depth_min_m || z > noise.depth_max_m)) z = 0;
    }
  }
  Image<std::uint16_t> out(view.depth.width, view.depth.height);
  const float sx = static_cast<float>(cells.width) / static_cast<float>(out.width),
              sy = static_cast<float>(cells.height) / static_cast<float>(out.height);
  for (int v = 0; v < out.height; ++v)
    for (int u = 0; u < out.width; ++u)
      out.at(u, v) = units_of(blended(cells, (static_cast<float>(u) + 0.5f) * sx - 0.5f,
                                      (static_cast<float>(v) + 0.5f) * sy - 0.5f),
                              camera);
  return out;
}

}  // namespace vsgraphs
