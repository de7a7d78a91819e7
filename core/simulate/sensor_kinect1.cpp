// Structured light, as the first Kinect. Spread and steps of depth: Khoshelham and Elberink, "Accuracy and resolution of Kinect depth data
// for indoor mapping applications" (Sensors 12, 2012): 1.4e-3 z^2 m in all, steps of 1/8 px of disparity. Spread at a slant and along the
// image: Nguyen, Izadi and Lovell, "Modeling Kinect sensor noise" (3DIMPVT 2012). Slow bends of depth: Teichman, Miller and Thrun,
// "Unsupervised intrinsic calibration of depth sensors via SLAM" (RSS 2013).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/simulate/depth_sensors.h"

namespace vsgraphs {
namespace {

constexpr float focal_ir_px = 580;  // at 640 columns
constexpr float sigma_px = 0.05f;   // of disparity; with the steps it makes 0.062
constexpr float lateral_px = 0.8f;  // Nguyen et al.
constexpr float bias_px = 0.07f;    // slow bends, the same in all frames
constexpr float edge_limit_px = 0.4f, edge_spread_px = 0.6f;
constexpr float dark_level = 42;  // grey level below which the pattern fades
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

class Kinect1 {
 public:
  Kinect1(const NoiseOptions& noise, const Camera& camera, int frame, const ExactDepth& view)
      : noise_(noise),
        camera_(camera),
        view_(view),
        rng_(noise.seed, "kinect1", static_cast<std::uint64_t>(frame)),
        fixed_(noise.seed, "kinect1_bias", 0),
        scenery_(look_through(view, camera, glass, rng_)),
        inverse_(inverse_of(scenery_.depth_m)),
        wobble_(rng_, w(), h(), 4, true),
        blotches_(rng_, w(), h(), 5, false),
        across_(rng_, w(), h(), 3, true),
        down_(rng_, w(), h(), 3, true),
        bias_(fixed_, w(), h(), std::max(8, w() / 8), true),
        bf_(static_cast<float>(noise.baseline_m) * focal_ir_px * static_cast<float>(w()) / 640) {}

  Image<std::uint16_t> sensed() {
    Image<std::uint16_t> out(w(), h());
    const auto shift = static_cast<float>(noise_.baseline_m * camera_.fx);
    for (int v = 0; v < h(); ++v) {
      for (SmoothNoise* n : {&wobble_, &blotches_, &across_, &down_, &bias_}) n->select_row(v);
      shadow_row(scenery_.depth_m, v, shift, hidden_);
      for (int u = 0; u < w(); ++u) out.at(u, v) = units_of(reading(u, v), camera_);
    }
    return out;
  }

 private:
  int w() const { return view_.depth.width; }
  int h() const { return view_.depth.height; }

  float reading(int u, int v) {
    // Patches are matched: what is read belongs to a place nearby.
    const float spread = blend_gain * lateral_px;
    const int x = std::clamp(u + static_cast<int>(std::lround(spread * across_.at(u))), 0, w() - 1);
    const int y = std::clamp(v + static_cast<int>(std::lround(spread * down_.at(u))), 0, h() - 1);
    const float z = scenery_.depth_m.at(x, y);
    if (z <= 0 || scenery_.lost.at(x, y) || hidden_[static_cast<std::size_t>(x)]) return 0;
    const float cosine = view_.incidence.empty() ? 1.0f : view_.incidence.at(x, y);
    if (noise_.depth_holes && is_lost(x, y, z, cosine)) return 0;
    const float sigma = sigma_px + slant_sigma(z, cosine) * bf_ / (z * z);
    const float disparity = bf_ / z + blend_gain * (sigma * wobble_.at(u) + bias_px * bias_.at(u));
    const auto step = static_cast<float>(noise_.disparity_step_px);
    const float steps = noise_.depth_quantisation ? std::round(disparity / step) : disparity / step;
    if (steps < 1) return 0;
    const float read = bf_ / (step * steps);
    return read >= noise_.depth_min_m && read <= noise_.depth_max_m ? read : 0.0f;
  }

  bool is_lost(int x, int y, float z, float cosine) const {
    const float chance = spread_evenly(blotches_.at(x));
    const float grey = view_.colour != nullptr ? luminance(view_.colour->at(x, y)) : 128.0f;
    float share = loss(z, cosine, grey);
    if (view_.label.at(x, y) == static_cast<std::uint8_t>(SceneClass::window) && view_.pane.empty())
      share += 0.75f;
    if (chance < share) return true;
    return bf_ * bend_at(inverse_, x, y, 2) > edge_limit_px + edge_spread_px * chance;
  }

  const NoiseOptions& noise_;
  const Camera& camera_;
  const ExactDepth& view_;
  Rng rng_, fixed_;
  Scenery scenery_;
  Image<float> inverse_;
  SmoothNoise wobble_, blotches_, across_, down_, bias_;
  std::vector<std::uint8_t> hidden_;
  float bf_;
};

}  // namespace

Image<std::uint16_t> sense_kinect1(const NoiseOptions& noise, const Camera& camera, int frame,
                                   const ExactDepth& view) {
  return Kinect1(noise, camera, frame, view).sensed();
}

}  // namespace vsgraphs
