#include "simulate/depth_sensors.h"

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
  o.auto_exposure = true, o.exposure_time_s = 0.012, o.softness_px = 0.8;
  o.rolling_shutter_s = 0.02, o.depth_delay_s = 0.012;
  o.misregistration_u_px = 0.5, o.misregistration_v_px = -1.0, o.misregistration_baseline_m = 0.003;
  o.image_sigma = 3.0, o.border_right = 0.06, o.border_top = 0.06;
}
void as_kinect2(NoiseOptions& o) {
  o.depth_min_m = 0.5, o.depth_max_m = 4.5;
  o.auto_exposure = true, o.exposure_time_s = 0.012, o.softness_px = 0.8;
  o.rolling_shutter_s = 0.02, o.depth_delay_s = 0.006;
  o.misregistration_u_px = 0.5, o.misregistration_baseline_m = 0.003;
}
void as_d435(NoiseOptions& o) {
  o.baseline_m = 0.05, o.disparity_step_px = 1.0 / 32, o.disparity_sigma_px = 0.08;
  o.depth_min_m = 0.28, o.depth_max_m = 10.0;
  o.auto_exposure = true, o.exposure_time_s = 0.008, o.softness_px = 0.7;
  o.rolling_shutter_s = 0.015, o.depth_delay_s = 0.003;
  o.misregistration_u_px = 0.4, o.misregistration_baseline_m = 0.001;
}
void as_iphone(NoiseOptions& o) {
  o.depth_min_m = 0.2, o.depth_max_m = 5.0;
  o.auto_exposure = true, o.exposure_time_s = 0.008, o.image_sigma = 1.6, o.softness_px = 0.5;
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
  Scenery out{Image<float>(w, h), {}};
  const float per_unit = static_cast<float>(1 / camera.depth_scale);
  for (std::size_t i = 0; i < out.depth_m.pixels.size(); ++i)
    out.depth_m.pixels[i] = per_unit * static_cast<float>(view.depth.pixels[i]);
  if (view.pane.empty()) return out;
  out.lost = Image<std::uint8_t>(w, h);
  SmoothNoise blotches(rng, w, h, 10, Drawn::uniform);
  const float head_on = std::cos(glass.head_on_deg * std::numbers::pi_v<float> / 180);
  for (int v = 0; v < h; ++v) {
    blotches.select_row(v);
    for (int u = 0; u < w; ++u) {
      const float pane = per_unit * view.pane.at(u, v);
      if (pane <= 0) continue;
      float& z = out.depth_m.at(u, v);
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
  }
  return out;
}

Image<float> inverse_of(const Image<float>& depth_m) {
  Image<float> out(depth_m.width, depth_m.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    out.pixels[i] = depth_m.pixels[i] > 0 ? 1 / depth_m.pixels[i] : 0.0f;
  return out;
}

void bend_row(const Image<float>& inverse_depth, int v, int reach, std::vector<float>& bends) {
  const int w = inverse_depth.width;
  bends.assign(static_cast<std::size_t>(w), 0.0f);
  const float* here = &inverse_depth.at(0, v);
  if (v >= reach && v + reach < inverse_depth.height) {
    const float *above = &inverse_depth.at(0, v - reach), *below = &inverse_depth.at(0, v + reach);
    for (int u = 0; u < w; ++u)
      bends[static_cast<std::size_t>(u)] = std::abs(above[u] + below[u] - 2 * here[u]);
  }
  float* out = bends.data();
  for (int u = reach; u + reach < w; ++u) {
    const float across = std::abs(here[u - reach] + here[u + reach] - 2 * here[u]);
    out[u] = out[u] < across ? across : out[u];
  }
}

void shadow_row(const Image<float>& inverse_depth, int v, float shift_px, std::vector<std::uint8_t>& hidden) {
  hidden.assign(static_cast<std::size_t>(inverse_depth.width), 0);
  const float* row = &inverse_depth.at(0, v);
  float leftmost = 1e9f;  // column of the projector reached so far, coming from the right
  for (int u = inverse_depth.width - 1; u >= 0; --u) {
    if (row[u] <= 0) continue;
    const float column = static_cast<float>(u) - shift_px * row[u];
    hidden[static_cast<std::size_t>(u)] = column > leftmost + 0.7f;
    leftmost = std::min(leftmost, column);
  }
}

}  // namespace vsgraphs
