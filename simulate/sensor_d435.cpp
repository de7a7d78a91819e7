// Active stereo, as the RealSense D435. Intel, "RealSense D400 series product family datasheet" (baseline 50 mm, field of view 87 degrees,
// 848 columns, range) and Grunnet-Jepsen, Sweetser and Woodfill, "Best-known-methods for tuning Intel RealSense D400 depth cameras for best
// performance" (2018): spread z^2 x subpixel error / (focal x baseline), subpixel error about 0.08 px; without texture in the picture
// stereo hangs on the projector, whose pattern fades with distance.
#include <algorithm>
#include <cmath>

#include "simulate/pixel_sensor.h"

namespace vsgraphs {
namespace {

constexpr float focal_stereo_px = 447;  // 848 columns over 87 degrees
constexpr float grain_px = 0.02f;       // what differs from pixel to pixel, of disparity
constexpr float textured = 3.0f;  // mean change of grey level between neighbours that stereo can do with
constexpr float full_pattern_m = 2.0f, no_pattern_m = 6.5f;
constexpr GlassAnswer glass{0.06f, 0.25f, 8, 0.1f, 0.5f, 0};

class D435 : PixelSensor {
 public:
  D435(const NoiseOptions& noise, const Camera& camera, int frame, const ExactDepth& view)
      : PixelSensor("d435", noise, camera, frame, view, glass),
        bumps_(field(9, Drawn::bell)),
        grain_(field(2, Drawn::bell)),
        blotches_(field(14, Drawn::uniform)),
        fattened_(field(4, Drawn::uniform)),
        bf_(static_cast<float>(noise.baseline_m) * focal_stereo_px) {}

  Image<std::uint16_t> sensed() {
    return read_rows(noise_.baseline_m, 1, [this](int u, int v) { return reading(u, v); });
  }

 private:
  float reading(int u, int v) const {
    const float z = fattened(u, v);
    if (z <= 0 || is_lost_at(u, v) || hidden(u)) return 0;
    if (noise_.depth_holes && is_lost(u, v, z)) return 0;
    const float fade = 1 + 0.4f * std::max(0.0f, z - 3);
    const float sigma = static_cast<float>(noise_.disparity_sigma_px) * fade;
    float disparity = bf_ / z;
    if (noise_.depth_quantisation) {
      disparity += blend_gain * (sigma * bumps_.at(u) + grain_px * grain_.at(u));
      const auto step = static_cast<float>(noise_.disparity_step_px);
      disparity = step * std::floor(disparity / step + 0.5f);
    }
    if (disparity <= 0) return 0;
    return within_range(std::floor(1000 * bf_ / disparity + 0.5f) / 1000);  // whole millimetres
  }

  // What stands before something else grows by a pixel or two: windows of matching reach over its edge.
  float fattened(int u, int v) const {
    const int reach = fattened_.at(u) > 0.5f ? 2 : 1;
    const float z = depth_at(u, v), left = depth_at(std::max(0, u - reach), v),
                right = depth_at(std::min(w() - 1, u + reach), v);
    const float nearest = std::min(left > 0 ? left : z, right > 0 ? right : z);
    return nearest < 0.9f * z ? nearest : z;
  }

  bool is_lost(int u, int v, float z) const {
    const float drawn = spread_evenly(blotches_.at(u));
    const float pattern = std::clamp((no_pattern_m - z) / (no_pattern_m - full_pattern_m), 0.0f, 1.0f);
    const float hold =
        pattern < 1 ? pattern + (1 - pattern) * std::min(1.0f, texture(u, v) / textured) : 1.0f;
    const float cosine = cosine_at(u, v);
    float share = 0.004f + 0.8f * (1 - hold);
    if (cosine < 0.2f) share += 1 - cosine / 0.2f;
    if (on_painted_window(u, v)) share += 0.4f;
    return drawn < share || bf_ * bend(u) > 2.5f + 2 * drawn;
  }

  // Mean change of grey level along the row around a pixel.
  float texture(int u, int v) const {
    if (view_.colour == nullptr) return 0;
    float sum = 0;
    constexpr int reach = 4;
    const int first = std::max(0, u - reach), last = std::min(w() - 1, u + reach);
    for (int x = first; x < last; ++x)
      sum += std::abs(luminance(view_.colour->at(x + 1, v)) - luminance(view_.colour->at(x, v)));
    // Noise of the image is no texture.
    return std::max(
        0.0f, sum / (2 * reach) - 1.2f * static_cast<float>(noise_.image_noise ? noise_.image_sigma : 0));
  }

  const SmoothNoise &bumps_, &grain_, &blotches_, &fattened_;
  float bf_;
};

}  // namespace

Image<std::uint16_t> sense_d435(const NoiseOptions& noise, const Camera& camera, int frame,
                                const ExactDepth& view) {
  return D435(noise, camera, frame, view).sensed();
}

}  // namespace vsgraphs
