// What matching a projected pattern makes of exact depth.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/rng.h"
#include "simulate/depth_sensors.h"
#include "simulate/sensor_noise.h"
#include "simulate/smooth_noise.h"

namespace vsgraphs {
namespace {

constexpr int wobble_spacing_px = 6, blotch_spacing_px = 24;
constexpr int edge_reach_px = 2;
constexpr float edge_limit_px = 0.4f,
                edge_spread_px = 0.6f;  // disparity bent by more than this has no reading

// Chance of losing a reading to distance: rare up to 3.5 m, one in six at 6 m.
float far_loss(float z) {
  return 0.0003f + 0.035f * std::clamp(z - 3.5f, 0.0f, 1.0f) + 0.10f * std::clamp(z - 4.6f, 0.0f, 1.5f);
}

// Whether each pixel of a row has no reading. Chances are drawn for blocks of 2 x 2 pixels: matching works on patches.
class Holes {
 public:
  Holes(const NoiseOptions& noise, Rng& rng, int width, int height)
      : rng_(rng),
        blotches_(rng, width, height, blotch_spacing_px, Drawn::uniform),
        grazing_(static_cast<float>(std::cos(noise.grazing_deg * std::numbers::pi / 180))),
        chances_(static_cast<std::size_t>(width / 2 + 1)) {}

  void select_row(int v) {
    blotches_.select_row(v);
    if (v % 2 == 0)
      for (float& chance : chances_) chance = static_cast<float>(rng_.uniform());
  }
  // bend: of the disparity there, pixels.
  bool at(int u, float bend, float z, float cosine, std::uint8_t label) const {
    const float chance = chances_[static_cast<std::size_t>(u / 2)];
    float loss = far_loss(z);
    if (cosine < grazing_) loss += 1 - cosine / grazing_;
    if (label == static_cast<std::uint8_t>(SceneClass::window)) loss += 4 * (blotches_.at(u) - 0.4f);
    return chance < loss || bend > edge_limit_px + edge_spread_px * chance;
  }

 private:
  Rng& rng_;
  SmoothNoise blotches_;
  float grazing_;
  std::vector<float> chances_;
};

}  // namespace

float incidence_cosine(const Camera& camera, const PixelForm<double>& form, double inverse_depth, double u,
                       double v) {
  // The form is n . ray / d with ray = (x, y, 1): its gradient is the normal, unscaled.
  const double nx = form.a * camera.fx, ny = form.b * camera.fy;
  const double nz = form.c + form.a * camera.cx + form.b * camera.cy;
  const double x = (u - camera.cx) / camera.fx, y = (v - camera.cy) / camera.fy;
  return static_cast<float>(std::abs(inverse_depth) /
                            std::sqrt((nx * nx + ny * ny + nz * nz) * (x * x + y * y + 1)));
}

Image<std::uint16_t> sense_depth(const NoiseOptions& noise, const Camera& camera, int frame,
                                 const Image<std::uint16_t>& exact, const Image<std::uint8_t>& label,
                                 const Image<float>& incidence) {
  Rng rng(noise.seed, "depth_noise", static_cast<std::uint64_t>(frame));
  SmoothNoise wobble(rng, exact.width, exact.height, wobble_spacing_px, Drawn::normal);
  Holes holes(noise, rng, exact.width, exact.height);
  const float scale = static_cast<float>(camera.depth_scale),
              bf = static_cast<float>(noise.baseline_m * camera.fx);
  Image<float> disparity(exact.width, exact.height);
  for (std::size_t i = 0; i < exact.pixels.size(); ++i)
    disparity.pixels[i] = exact.pixels[i] > 0 ? bf * scale / static_cast<float>(exact.pixels[i]) : 0.0f;
  const float step = static_cast<float>(noise.disparity_step_px);
  const float sigma = blend_gain * static_cast<float>(noise.disparity_sigma_px);
  const float nearest = static_cast<float>(noise.depth_min_m),
              farthest = static_cast<float>(noise.depth_max_m);
  Image<std::uint16_t> sensed(exact.width, exact.height);
  std::vector<float> bends;
  for (int v = 0; v < exact.height; ++v) {
    wobble.select_row(v);
    if (noise.depth_holes) bend_row(disparity, v, edge_reach_px, bends);
    holes.select_row(v);
    for (int u = 0; u < exact.width; ++u) {
      const float d = disparity.at(u, v);
      if (d <= 0) continue;
      float z = bf / d;
      if (noise.depth_holes &&
          holes.at(u, bends[static_cast<std::size_t>(u)], z, incidence.at(u, v), label.at(u, v)))
        continue;
      if (noise.depth_quantisation) {
        const float steps = std::floor((d + sigma * wobble.at(u)) / step + 0.5f);
        if (steps < 1) continue;
        z = bf / (step * steps);
      }
      if (noise.depth_holes && (z < nearest || z > farthest)) continue;
      const float raw = z * scale + 0.5f;
      sensed.at(u, v) = raw < 65536 ? static_cast<std::uint16_t>(raw) : std::uint16_t{0};
    }
  }
  return sensed;
}

}  // namespace vsgraphs
