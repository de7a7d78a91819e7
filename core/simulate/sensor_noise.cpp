#include "core/simulate/sensor_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/check.h"
#include "core/base/rng.h"

namespace vsgraphs {
namespace {

// Noise that varies smoothly from pixel to pixel: independent values on a coarse grid, blended bilinearly.
class SmoothNoise {
 public:
  SmoothNoise(Rng& rng, int width, int height, int spacing, bool gaussian)
      : spacing_(spacing),
        columns_(width / spacing + 2),
        nodes_(static_cast<std::size_t>(columns_) * (height / spacing + 2)),
        row_(static_cast<std::size_t>(columns_)) {
    for (float& n : nodes_) n = static_cast<float>(gaussian ? rng.normal() : rng.uniform());
  }
  void select_row(int v) {
    const int j = v / spacing_;
    const float f = static_cast<float>(v % spacing_) / static_cast<float>(spacing_);
    const float* a = nodes_.data() + static_cast<std::ptrdiff_t>(j) * columns_;
    for (int i = 0; i < columns_; ++i)
      row_[static_cast<std::size_t>(i)] = (1 - f) * a[i] + f * a[i + columns_];
  }
  float at(int u) const {
    const int i = u / spacing_;
    const float f = static_cast<float>(u % spacing_) / static_cast<float>(spacing_);
    return (1 - f) * row_[static_cast<std::size_t>(i)] + f * row_[static_cast<std::size_t>(i) + 1];
  }

 private:
  int spacing_, columns_;
  std::vector<float> nodes_, row_;
};

// Blending 2 x 2 independent values averages their variance down to 4/9 over the cell.
constexpr float blend_gain = 1.5f;

}  // namespace

NoiseOptions NoiseOptions::none() {
  NoiseOptions off;
  off.depth_quantisation = off.depth_holes = off.exposure = off.motion_blur = off.image_noise = false;
  return off;
}

void NoiseOptions::validate() const {
  const auto within = [](double value, double low, double high, const char* name) {
    require_input(
        std::isfinite(value) && value >= low && value <= high,
        std::string("noise.") + name + ": must lie in " + std::to_string(low) + ".." + std::to_string(high));
  };
  within(baseline_m, 0.001, 2, "baseline_m");
  within(disparity_step_px, 1e-3, 4, "disparity_step_px");
  within(disparity_sigma_px, 0, 4, "disparity_sigma_px");
  within(depth_min_m, 0, 10, "depth_min_m");
  within(depth_max_m, 0.1, 13, "depth_max_m");
  within(grazing_deg, 0, 90, "grazing_deg");
  within(exposure_amplitude, 0, 0.9, "exposure_amplitude");
  within(exposure_time_s, 0, 0.2, "exposure_time_s");
  within(image_sigma, 0, 60, "image_sigma");
}

float incidence_cosine(const Camera& camera, const PixelForm<double>& form, double inverse_depth, int u,
                       int v) {
  // The form is n . ray / d with ray = (x, y, 1): its gradient is the normal, unscaled.
  const double nx = form.a * camera.fx, ny = form.b * camera.fy;
  const double nz = form.c + form.a * camera.cx + form.b * camera.cy;
  const double x = (u - camera.cx) / camera.fx, y = (v - camera.cy) / camera.fy;
  return static_cast<float>(std::abs(inverse_depth) /
                            std::sqrt((nx * nx + ny * ny + nz * nz) * (x * x + y * y + 1)));
}

float exposure_gain(const NoiseOptions& noise, double time_s) {
  Rng rng(noise.seed, "exposure", 0);
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    sum += std::sin(2 * std::numbers::pi * (rng.uniform(0.05, 0.35) * time_s + rng.uniform())) / 3;
  return static_cast<float>(1 + noise.exposure_amplitude * sum);
}

void develop(const NoiseOptions& noise, int frame, float scale, const std::vector<float>& colour,
             Image<Rgb>& rgb) {
  Rng rng(noise.seed, "image_noise", static_cast<std::uint64_t>(frame));
  // Drawing a normal per channel would cost more than the rendering: a table is read from a random place per row.
  constexpr std::size_t table_size = 16384;
  std::vector<float> table;
  if (noise.image_noise) {
    table.resize(table_size);
    for (float& x : table) x = static_cast<float>(noise.image_sigma * rng.normal());
  }
  const std::size_t row_values = 3 * static_cast<std::size_t>(rgb.width);
  std::vector<float> row(row_values);
  for (int v = 0; v < rgb.height; ++v) {
    const float* in = colour.data() + row_values * static_cast<std::size_t>(v);
    for (std::size_t i = 0; i < row_values; ++i) row[i] = scale * in[i] + 0.5f;
    if (noise.image_noise) {
      std::size_t at = rng.index(table_size);
      for (std::size_t i = 0; i < row_values; ++i) {
        // Saturated pixels show no noise in real cameras either; dark ones show a little less than bright ones.
        row[i] += table[at] * (0.7f + 0.0025f * std::min(row[i], 120.0f));
        at = (at + 1) % table_size;
      }
    }
    Rgb* out = &rgb.at(0, v);
    const auto byte = [](float x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0f, 255.0f)); };
    for (int u = 0; u < rgb.width; ++u) {
      const float* c = row.data() + 3 * u;
      out[u] = {byte(c[0]), byte(c[1]), byte(c[2])};
    }
  }
}

namespace {

// Chance of losing a reading to distance: rare up to 4 m, one in six at 6 m.
float far_loss(float z) {
  return 0.002f + 0.04f * std::clamp(z - 3.5f, 0.0f, 1.0f) + 0.10f * std::clamp(z - 4.6f, 0.0f, 1.5f);
}

// How much disparity bends around (u, v) over `reach` pixels in both directions: zero on planes, the jump at edges.
float bend_px(const Image<float>& disparity, int u, int v, int reach) {
  const int u0 = std::max(u - reach, 0), u1 = std::min(u + reach, disparity.width - 1);
  const int v0 = std::max(v - reach, 0), v1 = std::min(v + reach, disparity.height - 1);
  const float here = disparity.at(u, v);
  const float across = u1 - u0 == 2 * reach ? disparity.at(u0, v) + disparity.at(u1, v) - 2 * here : 0.0f;
  const float down = v1 - v0 == 2 * reach ? disparity.at(u, v0) + disparity.at(u, v1) - 2 * here : 0.0f;
  return std::max(std::abs(across), std::abs(down));
}

}  // namespace

Image<std::uint16_t> sense_depth(const NoiseOptions& noise, const Camera& camera, int frame,
                                 const Image<std::uint16_t>& exact, const Image<std::uint8_t>& label,
                                 const Image<float>& incidence) {
  const auto id = static_cast<std::uint64_t>(frame);
  Rng rng(noise.seed, "depth_noise", id);
  SmoothNoise wobble(rng, exact.width, exact.height, 5, true);
  SmoothNoise blotches(rng, exact.width, exact.height, 24, false);
  const float scale = static_cast<float>(camera.depth_scale),
              bf = static_cast<float>(noise.baseline_m * camera.fx);
  Image<float> disparity(exact.width, exact.height);
  for (std::size_t i = 0; i < exact.pixels.size(); ++i)
    disparity.pixels[i] = exact.pixels[i] > 0 ? bf * scale / static_cast<float>(exact.pixels[i]) : 0.0f;
  const float step = static_cast<float>(noise.disparity_step_px);
  const float sigma = blend_gain * static_cast<float>(noise.disparity_sigma_px);
  const float grazing = static_cast<float>(std::cos(noise.grazing_deg * std::numbers::pi / 180));
  Image<std::uint16_t> sensed(exact.width, exact.height);
  for (int v = 0; v < exact.height; ++v) {
    wobble.select_row(v), blotches.select_row(v);
    for (int u = 0; u < exact.width; ++u) {
      const float d = disparity.at(u, v);
      if (d <= 0) continue;
      float z = bf / d;
      if (noise.depth_holes) {
        const float chance = static_cast<float>(rng.uniform());
        const float limit = 1.0f + 1.2f * chance;  // ragged edges
        float loss = far_loss(z);
        const float cosine = incidence.at(u, v);
        if (cosine < grazing) loss += 1 - cosine / grazing;
        if (label.at(u, v) == static_cast<std::uint8_t>(SceneClass::window))
          loss += 4 * (blotches.at(u) - 0.4f);
        if (chance < loss || bend_px(disparity, u, v, 2) > limit) continue;
      }
      if (noise.depth_quantisation) {
        const float steps = std::round((d + sigma * wobble.at(u)) / step);
        if (steps < 1) continue;
        z = bf / (step * steps);
      }
      if (noise.depth_holes &&
          (z < static_cast<float>(noise.depth_min_m) || z > static_cast<float>(noise.depth_max_m)))
        continue;
      const float raw = z * scale + 0.5f;
      sensed.at(u, v) = raw < 65536 ? static_cast<std::uint16_t>(raw) : std::uint16_t{0};
    }
  }
  return sensed;
}

}  // namespace vsgraphs
