// Structured light, as the first Kinect. Spread and steps of depth: Khoshelham and Elberink, "Accuracy and resolution of Kinect depth data
// for indoor mapping applications" (Sensors 12, 2012): 1.4e-3 z^2 m in all, steps of 1/8 px of disparity. Spread at a slant and along the
// image: Nguyen, Izadi and Lovell, "Modeling Kinect sensor noise" (3DIMPVT 2012). Slow bends of depth: Teichman, Miller and Thrun,
// "Unsupervised intrinsic calibration of depth sensors via SLAM" (RSS 2013).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/pixel_sensor.h"

namespace vsgraphs {
namespace {

constexpr float focal_ir_px = 580;  // at 640 columns
constexpr float sigma_px = 0.048f;  // of disparity; with the steps it makes 0.060
constexpr float near_m =
    0.0008f;  // what does not shrink with the distance; Nguyen et al. have 1.2 mm at 0.4 m in all
constexpr float lateral_px = 0.8f;  // Nguyen et al.
constexpr float bias_px = 0.07f;    // slow bends, the same in all frames
constexpr float edge_limit_px = 0.4f, edge_spread_px = 0.6f, blurred_from_px = 0.3f;  // bends of disparity
constexpr float fine_share = 0.35f;  // of what decides on losses: the rest goes by patches of a hand's size
constexpr float glossy_loss = 0.4f;  // of screens, which throw the pattern elsewhere
constexpr float dark_level = 42;     // grey level below which the pattern fades
constexpr GlassAnswer glass{0.08f, 0.22f, 12, 0.1f, 0.75f, 0};

// Chance of losing a reading to distance, slant and dark surfaces.
float loss(float z, float cosine, float grey) {
  float chance = 0.001f + 0.02f * std::clamp(z - 3.5f, 0.0f, 1.0f) + 0.08f * std::clamp(z - 4.5f, 0.0f, 4.0f);
  const float grazing = 0.26f;  // 75 degrees
  if (cosine < grazing) chance += 1 - cosine / grazing;
  if (grey < dark_level) chance += (1 - grey / dark_level) * std::clamp(0.35f * (z - 0.8f), 0.0f, 0.9f);
  return chance;
}

// Nguyen's axial spread beyond 60 degrees, as metres to be added.
float slant_sigma(float z, float cosine) {
  const float theta = std::acos(std::clamp(cosine, 0.05f, 1.0f));
  if (theta < std::numbers::pi_v<float> / 3) return 0;
  const float rest = std::numbers::pi_v<float> / 2 - theta;
  return 0.0001f / std::sqrt(z) * theta * theta / (rest * rest);
}

class Kinect1 : PixelSensor {
 public:
  Kinect1(const NoiseOptions& noise, const Camera& camera, int frame, const ExactDepth& view)
      : PixelSensor("kinect1", noise, camera, frame, view, glass),
        fixed_(noise.seed, "kinect1_bias", 0),
        wobble_(field(4, Drawn::bell)),
        blotches_(field(5, Drawn::uniform)),
        patches_(field(22, Drawn::uniform)),
        across_(field(3, Drawn::bell)),
        down_(field(3, Drawn::bell)),
        bias_(field(fixed_, std::max(8, w() / 8), Drawn::bell)),
        bf_(static_cast<float>(noise.baseline_m) * focal_ir_px * static_cast<float>(w()) / 640) {}

  Image<std::uint16_t> sensed() {
    return read_rows(noise_.baseline_m, 2, [this](int u, int v) { return reading(u, v); });
  }

 private:
  float reading(int u, int v) const {
    int x = u, y = v;
    const float edge = bf_ * bend(u);
    if (edge > blurred_from_px) {  // patches are matched: at edges what is read belongs to a place nearby
      const float spread = blend_gain * lateral_px;
      x = std::clamp(u + nearest(spread * across_.at(u)), 0, w() - 1);
      y = std::clamp(v + nearest(spread * down_.at(u)), 0, h() - 1);
    }
    const float z = depth_at(x, y);
    if (z <= 0 || is_lost_at(x, y) || hidden(x)) return 0;
    const float cosine = cosine_at(x, y);
    if (noise_.depth_holes && is_lost(x, y, z, cosine, edge)) return 0;
    const float px_per_m = bf_ / (z * z);
    float sigma = std::sqrt(sigma_px * sigma_px + near_m * near_m * px_per_m * px_per_m);
    if (cosine < 0.5f) sigma += slant_sigma(z, cosine) * px_per_m;
    const float disparity = bf_ / z + blend_gain * (sigma * wobble_.at(u) + bias_px * bias_.at(u));
    const auto step = static_cast<float>(noise_.disparity_step_px);
    const float steps = noise_.depth_quantisation ? std::floor(disparity / step + 0.5f) : disparity / step;
    return steps < 1 ? 0.0f : within_range(bf_ / (step * steps));
  }

  bool is_lost(int x, int y, float z, float cosine, float edge) const {
    const float fine = spread_evenly(blotches_.at(x)), coarse = spread_evenly(patches_.at(x));
    const float chance = spread_evenly(fine_share * fine + (1 - fine_share) * coarse);
    float share = loss(z, cosine, grey_at(x, y));
    if (on_painted_window(x, y)) share += 0.75f;
    if (is(SceneClass::screen, x, y)) share += glossy_loss;
    return chance < share || edge > edge_limit_px + edge_spread_px * chance;
  }

  static int nearest(float x) { return static_cast<int>(std::floor(x + 0.5f)); }

  Rng fixed_;
  const SmoothNoise &wobble_, &blotches_, &patches_, &across_, &down_, &bias_;
  float bf_;
};

}  // namespace

Image<std::uint16_t> sense_kinect1(const NoiseOptions& noise, const Camera& camera, int frame,
                                   const ExactDepth& view) {
  return Kinect1(noise, camera, frame, view).sensed();
}

}  // namespace vsgraphs
