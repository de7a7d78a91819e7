// Internal to core/simulate: the depth sensors there are, each a function from exact depth to what it reads. What each is modelled on
// stands above its function and in docs/simulator.md.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "simulate/sensor_noise.h"
#include "simulate/smooth_noise.h"

namespace vsgraphs {

using SenseDepth = Image<std::uint16_t> (*)(const NoiseOptions&, const Camera&, int frame, const ExactDepth&);

struct DepthSensor {
  std::string_view name;
  SenseDepth sense;
  void (*adjust)(NoiseOptions&) = nullptr;  // the options that come with it
  int width = 0, height = 0;                // of its images; 0: the plan's usual camera
  double focal_px = 0;
};

std::span<const DepthSensor> depth_sensors();
const DepthSensor& depth_sensor(const std::string& name);  // InputError naming those there are

Image<std::uint16_t> sense_kinect1(const NoiseOptions&, const Camera&, int frame, const ExactDepth&);
Image<std::uint16_t> sense_kinect2(const NoiseOptions&, const Camera&, int frame, const ExactDepth&);
Image<std::uint16_t> sense_d435(const NoiseOptions&, const Camera&, int frame, const ExactDepth&);
Image<std::uint16_t> sense_iphone_lidar(const NoiseOptions&, const Camera&, int frame, const ExactDepth&);

// What a sensor makes of a pane of glass. Shares of pixels; the rest sees through to what is behind.
struct GlassAnswer {
  float own = 0.05f, nothing = 0.2f;                                   // at a slant
  float head_on_deg = 10, own_head_on = 0.1f, nothing_head_on = 0.8f;  // nearly square to the pane
  float mixed = 0;  // share of the pane in the way measured through it
};

// Exact depth as an image of metres (0: nothing there), with glass answered for: `lost` marks pixels without an answer; empty where there is
// no glass.
struct Scenery {
  Image<float> depth_m;
  Image<std::uint8_t> lost;
};
Scenery look_through(const ExactDepth& view, const Camera& camera, const GlassAnswer& glass, Rng& rng);

// How much inverse depth bends around each pixel of a row over `reach` pixels, in 1/m: zero on planes, large at edges.
void bend_row(const Image<float>& inverse_depth, int v, int reach, std::vector<float>& bends);
Image<float> inverse_of(const Image<float>& depth_m);
// Pixels of a row that a projector (or second camera) `shift_px` = focal x baseline to the right does not see.
void shadow_row(const Image<float>& inverse_depth, int v, float shift_px, std::vector<std::uint8_t>& hidden);
inline float luminance(Rgb c) { return 0.3f * c.r + 0.59f * c.g + 0.11f * c.b; }
// Depth in camera units; 0 where it is beyond them.
inline std::uint16_t units_of(float depth_m, const Camera& camera) {
  const float raw = depth_m * static_cast<float>(camera.depth_scale) + 0.5f;
  return raw >= 1 && raw < 65536 ? static_cast<std::uint16_t>(static_cast<std::int32_t>(raw))
                                 : std::uint16_t{0};
}

}  // namespace vsgraphs
