// Time of flight, as the second Kinect. Sarbolandi, Lefloch and Kolb, "Kinect range sensing: structured-light versus time-of-flight Kinect"
// (CVIU 139, 2015): spread with distance, slant and reflectivity, periodic error, flying pixels, multiple paths. Wasenmueller and Stricker,
// "Comparison of Kinect v1 and v2 depth images in terms of accuracy and precision" (ACCV workshops 2016): an offset of -18 mm at any
// distance, a spread below 2 mm in the middle at 1 m to 5 mm at 4 m that grows towards the corners of the image.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/simulate/depth_sensors.h"

namespace vsgraphs {
namespace {

constexpr float offset_m = -0.018f;
constexpr float periodic_m = 0.004f, period_m = 0.94f;  // half the wavelength of 160 MHz
constexpr float corner_gain = 0.35f, corner_reach_m = 0.12f, most_corner_m = 0.03f;
constexpr float flying_kept = 0.45f;  // of the pixels on an edge
constexpr GlassAnswer glass{0.06f, 0.12f, 8, 0.45f, 0.4f, 0.06f};

class Kinect2 {
 public:
  Kinect2(const NoiseOptions& noise, const Camera& camera, int frame, const ExactDepth& view)
      : noise_(noise),
        camera_(camera),
        view_(view),
        rng_(noise.seed, "kinect2", static_cast<std::uint64_t>(frame)),
        scenery_(look_through(view, camera, glass, rng_)),
        inverse_(inverse_of(scenery_.depth_m)),
        shot_(rng_, w(), h(), 1, true),
        blotches_(rng_, w(), h(), 2, false) {}

  Image<std::uint16_t> sensed() {
    Image<std::uint16_t> out(w(), h());
    for (int v = 0; v < h(); ++v) {
      shot_.select_row(v), blotches_.select_row(v);
      for (int u = 0; u < w(); ++u) out.at(u, v) = units_of(reading(u, v), camera_);
    }
    return out;
  }

 private:
  int w() const { return view_.depth.width; }
  int h() const { return view_.depth.height; }

  float reading(int u, int v) {
    float z = scenery_.depth_m.at(u, v);
    if (z <= 0 || scenery_.lost.at(u, v)) return 0;
    const float cosine = view_.incidence.empty() ? 1.0f : std::max(0.02f, view_.incidence.at(u, v));
    const float grey = view_.colour != nullptr ? luminance(view_.colour->at(u, v)) : 128.0f;
    const float drawn = spread_evenly(blotches_.at(u));
    // Light that comes back, against that of a light wall at 1 m.
    const float light = cosine * (0.25f + grey / 170) / (z * z);
    if (noise_.depth_holes) {
      if (light < 0.008f + 0.006f * drawn) return 0;
      if (view_.label.at(u, v) == static_cast<std::uint8_t>(SceneClass::window) && view_.pane.empty() &&
          drawn > 0.3f)
        return 0;
      if (on_edge(u, v, z)) {
        if (drawn > flying_kept) return 0;
        z = flying(u, v, z, drawn / flying_kept);
      }
    }
    if (noise_.depth_quantisation) z += error(u, v, z, light);
    return z >= noise_.depth_min_m && z <= noise_.depth_max_m ? z : 0.0f;
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
      const float before = scenery_.depth_m.at(u - du, v - dv), behind = scenery_.depth_m.at(u + du, v + dv);
      if (before <= 0 || behind <= 0 || std::abs(before - behind) > 4 * corner_reach_m) continue;
      deepest = std::max(deepest, z - 2 / (1 / before + 1 / behind));
    }
    return deepest < 0.25f ? std::min(most_corner_m, corner_gain * deepest) : 0.0f;
  }

  bool on_edge(int u, int v, float z) const { return z * z * bend_at(inverse_, u, v, 1) > 0.04f + 0.02f * z; }

  // Between what is before and what is behind the edge.
  float flying(int u, int v, float z, float share) const {
    float other = z;
    for (const auto& [du, dv] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
      const float there = scenery_.depth_m.at(std::clamp(u + du, 0, w() - 1), std::clamp(v + dv, 0, h() - 1));
      if (there > 0 && std::abs(there - z) > std::abs(other - z)) other = there;
    }
    return z + share * (other - z);
  }

  const NoiseOptions& noise_;
  const Camera& camera_;
  const ExactDepth& view_;
  Rng rng_;
  Scenery scenery_;
  Image<float> inverse_;
  SmoothNoise shot_, blotches_;
};

}  // namespace

Image<std::uint16_t> sense_kinect2(const NoiseOptions& noise, const Camera& camera, int frame,
                                   const ExactDepth& view) {
  return Kinect2(noise, camera, frame, view).sensed();
}

}  // namespace vsgraphs
