#include "core/simulate/depth_sensors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

Image<std::uint16_t> sense_classic(const NoiseOptions& noise, const Camera& camera, int frame,
                                   const ExactDepth& view) {
  return sense_depth(noise, camera, frame, view.depth, view.label, view.incidence);
}

// Shutters, delays and ranges of the cameras as sold; what is measured about depth is in each sensor's own file.
void as_kinect1(NoiseOptions& o) {
  o.depth_min_m = 0.45, o.depth_max_m = 8.0;
  o.auto_exposure = true, o.exposure_time_s = 0.012;
  o.rolling_shutter_s = 0.02, o.depth_delay_s = 0.012;
  o.misregistration_u_px = 1.5, o.misregistration_v_px = -1.0;
}
void as_kinect2(NoiseOptions& o) {
  o.depth_min_m = 0.5, o.depth_max_m = 4.5;
  o.auto_exposure = true, o.exposure_time_s = 0.012;
  o.rolling_shutter_s = 0.02, o.depth_delay_s = 0.006, o.misregistration_u_px = 1.0;
}
void as_d435(NoiseOptions& o) {
  o.baseline_m = 0.05, o.disparity_step_px = 1.0 / 32, o.disparity_sigma_px = 0.08;
  o.depth_min_m = 0.28, o.depth_max_m = 10.0;
  o.auto_exposure = true, o.exposure_time_s = 0.008;
  o.rolling_shutter_s = 0.015, o.depth_delay_s = 0.003, o.misregistration_u_px = 0.7;
}
void as_iphone(NoiseOptions& o) {
  o.depth_min_m = 0.2, o.depth_max_m = 5.0;
  o.auto_exposure = true, o.exposure_time_s = 0.008, o.image_sigma = 1.6;
  o.rolling_shutter_s = 0.012;
}

constexpr DepthSensor table[] = {
    {"classic", sense_classic},
    {"clean", sense_classic},
    {"kinect1", sense_kinect1, as_kinect1, 640, 480, 525},
    {"kinect2", sense_kinect2, as_kinect2, 512, 424, 366},
    {"d435", sense_d435, as_d435, 640, 480, 615},
    {"iphone_lidar", sense_iphone_lidar, as_iphone, 640, 480, 490},
};

}  // namespace

std::span<const DepthSensor> depth_sensors() { return table; }

const DepthSensor& depth_sensor(const std::string& name) {
  std::string known;
  for (const DepthSensor& sensor : table) {
    if (sensor.name == name) return sensor;
    known += (known.empty() ? "" : ", ") + std::string(sensor.name);
  }
  throw InputError("sensor: must be one of " + known + ", not \"" + name + "\"");
}

Scenery look_through(const ExactDepth& view, const Camera& camera, const GlassAnswer& glass, Rng& rng) {
  const int w = view.depth.width, h = view.depth.height;
  Scenery out{Image<float>(w, h), Image<std::uint8_t>(w, h)};
  const float per_unit = static_cast<float>(1 / camera.depth_scale);
  SmoothNoise blotches(rng, w, h, 10, false);
  const float head_on = std::cos(glass.head_on_deg * std::numbers::pi_v<float> / 180);
  for (int v = 0; v < h; ++v) {
    blotches.select_row(v);
    for (int u = 0; u < w; ++u) {
      float z = per_unit * view.depth.at(u, v);
      const float pane = view.pane.empty() ? 0.0f : per_unit * view.pane.at(u, v);
      if (pane > 0) {
        const bool square = view.pane_incidence.at(u, v) > head_on;
        const float own = square ? glass.own_head_on : glass.own,
                    nothing = square ? glass.nothing_head_on : glass.nothing;
        const float drawn = spread_evenly(blotches.at(u));
        if (drawn < own)
          z = pane;
        else if (drawn > 1 - nothing)
          out.lost.at(u, v) = 1;
        else if (z > 0)
          z += glass.mixed * (pane - z);
      }
      out.depth_m.at(u, v) = z;
    }
  }
  return out;
}

Image<float> inverse_of(const Image<float>& depth_m) {
  Image<float> out(depth_m.width, depth_m.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    out.pixels[i] = depth_m.pixels[i] > 0 ? 1 / depth_m.pixels[i] : 0.0f;
  return out;
}

float bend_at(const Image<float>& inverse_depth, int u, int v, int reach) {
  const bool inner_u = u >= reach && u + reach < inverse_depth.width;
  const bool inner_v = v >= reach && v + reach < inverse_depth.height;
  const float* here = &inverse_depth.at(u, v);
  const std::ptrdiff_t rows = static_cast<std::ptrdiff_t>(reach) * inverse_depth.width;
  const float across = inner_u ? here[-reach] + here[reach] - 2 * *here : 0.0f;
  const float down = inner_v ? here[-rows] + here[rows] - 2 * *here : 0.0f;
  return std::max(std::abs(across), std::abs(down));
}

void shadow_row(const Image<float>& depth_m, int v, float shift_px, std::vector<std::uint8_t>& hidden) {
  hidden.assign(static_cast<std::size_t>(depth_m.width), 0);
  float leftmost = 1e9f;  // column of the projector reached so far, coming from the right
  for (int u = depth_m.width - 1; u >= 0; --u) {
    const float z = depth_m.at(u, v);
    if (z <= 0) continue;
    const float column = static_cast<float>(u) - shift_px / z;
    if (column > leftmost + 0.7f) hidden[static_cast<std::size_t>(u)] = 1;
    leftmost = std::min(leftmost, column);
  }
}

float luminance(Rgb c) { return 0.3f * c.r + 0.59f * c.g + 0.11f * c.b; }

std::uint16_t units_of(float depth_m, const Camera& camera) {
  const float raw = depth_m * static_cast<float>(camera.depth_scale) + 0.5f;
  return raw >= 1 && raw < 65536 ? static_cast<std::uint16_t>(raw) : std::uint16_t{0};
}

}  // namespace vsgraphs
