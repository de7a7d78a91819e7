// Automatic exposure: what the camera made of the light of the last second or two.
#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/renderer.h"
#include "simulate/sensor_noise.h"
#include "simulate/shading.h"

namespace vsgraphs {
namespace {

constexpr double aimed_at = 112;  // mean grey level
constexpr double shortest_s = 0.001, most_gain = 12, lag_s = 0.6;
constexpr std::array ago_s{0.05, 0.25, 0.5, 0.9, 1.4};

}  // namespace

Camera Renderer::meter_of(const Camera& camera) {
  constexpr double columns = 40;
  Camera meter = camera;
  const double scale = columns / camera.width;
  meter.width = static_cast<int>(columns);
  meter.height = std::max(1, static_cast<int>(std::lround(camera.height * scale)));
  meter.fx *= scale, meter.fy *= scale;
  meter.cx = (camera.cx + 0.5) * scale - 0.5, meter.cy = (camera.cy + 0.5) * scale - 0.5;
  return meter;
}

// Mean grey level of the image at this moment, at an unchanged exposure.
double Renderer::brightness_at(double time_s) {
  const Camera& meter = meter_;
  VisibilityBuffer& buffer = meter_buffer_;
  const View view{&meter, camera_at(time_s).inverse(), 0, 0, time_s};
  buffer.draw(scene_, view, visible_rooms(scene_, view));
  double sum = 0;
  for (int v = 0; v < meter.height; ++v) {
    for (int u = 0; u < meter.width; ++u) {
      const std::int32_t seen = buffer.face_row(v)[u];
      if (seen < 0) continue;
      const auto i = static_cast<std::size_t>(seen);
      const Face& face = scene_.faces[i % scene_.faces.size()];
      const Shader shader(face, buffer.views()[i], scene_.materials[static_cast<std::size_t>(face.material)]);
      const Colour colour = shade_point(shader, static_cast<float>(u), static_cast<float>(v), 0);
      for (const float c : {colour.r, colour.g, colour.b}) sum += std::min(c, 255.0f) / 3;
    }
  }
  return sum / (meter.width * meter.height);
}

Renderer::Exposure Renderer::exposure_at(double time_s) {
  const float wander = noise_.exposure ? exposure_gain(noise_, time_s) : 1.0f;
  Exposure out{noise_.motion_blur ? noise_.exposure_time_s : 0.0, wander, noise_.image_sigma};
  if (!noise_.auto_exposure) return out;
  double mean = 0, total = 0;
  for (const double ago : ago_s) {
    const double weight = std::exp(-ago / lag_s);
    mean += weight * brightness_at(std::max(0.0, time_s - ago)), total += weight;
  }
  // Exposure first, up to its limit; what is still missing is amplified, and the noise with it.
  const double needed = std::clamp(aimed_at / std::max(1.0, mean / total), 0.05, most_gain);
  const double time = std::clamp(noise_.exposure_time_s * needed, shortest_s, noise_.exposure_max_s);
  const double amplified = needed * noise_.exposure_time_s / time;
  out.time_s = noise_.motion_blur ? time : 0.0;
  out.gain = wander * static_cast<float>(needed);
  out.sigma = noise_.image_sigma * std::sqrt(std::max(0.25, amplified));
  return out;
}

}  // namespace vsgraphs
