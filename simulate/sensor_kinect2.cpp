// Time of flight, as the second Kinect. Sarbolandi, Lefloch and Kolb, "Kinect range sensing: structured-light versus time-of-flight Kinect"
// (CVIU 139, 2015): spread with distance, slant and reflectivity, periodic error, flying pixels, multiple paths. Wasenmueller and Stricker,
// "Comparison of Kinect v1 and v2 depth images in terms of accuracy and precision" (ACCV workshops 2016): an offset of -18 mm at any
// distance, a spread below 2 mm in the middle at 1 m to 5 mm at 4 m that grows towards the corners of the image.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/pixel_sensor.h"

namespace vsgraphs {
namespace {

constexpr float offset_m = -0.018f;
constexpr float periodic_m = 0.004f, period_m = 0.94f;  // half the wavelength of 160 MHz
constexpr float corner_gain = 0.35f, corner_reach_m = 0.12f, most_corner_m = 0.03f;
constexpr float flying_kept = 0.45f;  // of the pixels on an edge
constexpr GlassAnswer glass{0.06f, 0.12f, 8, 0.45f, 0.4f, 0.06f};

class Kinect2 : PixelSensor {
 public:
  Kinect2(const NoiseOptions& noise, const Camera& camera, int frame, const ExactDepth& view)
      : PixelSensor("kinect2", noise, camera, frame, view, glass),
        shot_(field(1, Drawn::bell)),
        blotches_(field(2, Drawn::uniform)) {}

  Image<std::uint16_t> sensed() {
    return read_rows(0, 1, [this](int u, int v) { return reading(u, v); });
  }

 private:
  float reading(int u, int v) const {
    float z = depth_at(u, v);
    if (z <= 0 || is_lost_at(u, v)) return 0;
    const float drawn = spread_evenly(blotches_.at(u));
    // Light that comes back, against that of a light wall at 1 m.
    const float light = std::max(0.02f, cosine_at(u, v)) * (0.25f + grey_at(u, v) / 170) / (z * z);
    if (noise_.depth_holes) {
      if (light < 0.008f + 0.006f * drawn || (on_painted_window(u, v) && drawn > 0.3f)) return 0;
      if (z * z * bend(u) > 0.04f + 0.02f * z) {
        if (drawn > flying_kept) return 0;
        z = flying(u, v, z, drawn / flying_kept);
      }
    }
    if (noise_.depth_quantisation) z += error(u, v, z, light);
    return within_range(z);
  }

  float error(int u, int v, float z, float light) const {
    const float x = (static_cast<float>(u) - 0.5f * static_cast<float>(w())) /
                    (0.5f * static_cast<float>(w())),
                y = (static_cast<float>(v) - 0.5f * static_cast<float>(h())) /
                    (0.5f * static_cast<float>(h()));
    const float r2 = 0.5f * (x * x + y * y);
    const float sigma = (0.0008f + 0.0003f / std::max(light, 0.02f)) * (1 + 1.5f * r2 * r2);
    const float periodic = periodic_m * std::sin(2 * std::numbers::pi_v<float> * z / period_m);
    return offset_m + periodic + sigma * shot_.at(u) + corner(u, v, z);
  }

  // Light that takes the way over the other wall of a corner makes it seem farther and round.
  float corner(int u, int v, float z) const {
    const int reach =
        std::clamp(static_cast<int>(corner_reach_m * static_cast<float>(camera_.fx) / z), 2, 60);
    float deepest = 0;
    for (const auto& [du, dv] : {std::pair{reach, 0}, std::pair{0, reach}}) {
      if (u < du || v < dv || u + du >= w() || v + dv >= h()) continue;
      const float before = depth_at(u - du, v - dv), behind = depth_at(u + du, v + dv);
      if (before <= 0 || behind <= 0 || std::abs(before - behind) > 4 * corner_reach_m) continue;
      deepest = std::max(deepest, z - 2 / (1 / before + 1 / behind));
    }
    return deepest < 0.25f ? std::min(most_corner_m, corner_gain * deepest) : 0.0f;
  }

  // Between what is before and what is behind the edge.
  float flying(int u, int v, float z, float share) const {
    float other = z;
    for (const auto& [du, dv] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
      const float there = depth_at(std::clamp(u + du, 0, w() - 1), std::clamp(v + dv, 0, h() - 1));
      if (there > 0 && std::abs(there - z) > std::abs(other - z)) other = there;
    }
    return z + share * (other - z);
  }

  const SmoothNoise &shot_, &blotches_;
};

}  // namespace

Image<std::uint16_t> sense_kinect2(const NoiseOptions& noise, const Camera& camera, int frame,
                                   const ExactDepth& view) {
  return Kinect2(noise, camera, frame, view).sensed();
}

}  // namespace vsgraphs
