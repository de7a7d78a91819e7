// Internal to core/simulate: what sensors that read depth pixel by pixel have in common: the scenery before them, fields of noise, rows in order,
// windows and range.
#pragma once

#include <deque>
#include <string_view>
#include <vector>

#include "simulate/depth_sensors.h"

namespace vsgraphs {

class PixelSensor {
 public:
  PixelSensor(std::string_view name, const NoiseOptions& noise, const Camera& camera, int frame,
              const ExactDepth& view, const GlassAnswer& glass)
      : noise_(noise),
        camera_(camera),
        view_(view),
        rng_(noise.seed, name, static_cast<std::uint64_t>(frame)),
        scenery_(look_through(view, camera, glass, rng_)),
        inverse_(inverse_of(scenery_.depth_m)) {}

 protected:
  int w() const { return view_.depth.width; }
  int h() const { return view_.depth.height; }
  float depth_at(int u, int v) const { return scenery_.depth_m.at(u, v); }
  bool is_lost_at(int u, int v) const { return !scenery_.lost.empty() && scenery_.lost.at(u, v) != 0; }
  float cosine_at(int u, int v) const { return view_.incidence.empty() ? 1.0f : view_.incidence.at(u, v); }
  float grey_at(int u, int v) const {
    return view_.colour != nullptr ? luminance(view_.colour->at(u, v)) : 128.0f;
  }
  bool is(SceneClass what, int u, int v) const {
    return view_.label.at(u, v) == static_cast<std::uint8_t>(what);
  }
  bool on_painted_window(int u, int v) const { return is(SceneClass::window, u, v) && view_.pane.empty(); }
  float within_range(float z) const {
    return z >= static_cast<float>(noise_.depth_min_m) && z <= static_cast<float>(noise_.depth_max_m) ? z
                                                                                                      : 0.0f;
  }
  // A field of noise of this frame, or of all frames alike.
  SmoothNoise& field(int spacing, Drawn drawn) { return field(rng_, spacing, drawn); }
  SmoothNoise& field(Rng& rng, int spacing, Drawn drawn) {
    return fields_.emplace_back(rng, w(), h(), spacing, drawn);
  }
  // Whether a projector or second camera to the right does not see a pixel of the row at hand.
  bool hidden(int u) const { return hidden_[static_cast<std::size_t>(u)] != 0; }
  float bend(int u) const { return bends_[static_cast<std::size_t>(u)]; }  // of inverse depth, 1/m

  // Rows from above: reading(u, v) in metres, 0 for none. `baseline_m`: to the second eye, 0: none; `reach`: of bends, pixels.
  template <typename Reading>
  Image<std::uint16_t> read_rows(double baseline_m, int reach, const Reading& reading) {
    Image<std::uint16_t> out(w(), h());
    const auto shift = static_cast<float>(baseline_m * camera_.fx);
    hidden_.assign(static_cast<std::size_t>(w()), 0);
    for (int v = 0; v < h(); ++v) {
      for (SmoothNoise& noise : fields_) noise.select_row(v);
      if (baseline_m > 0) shadow_row(inverse_, v, shift, hidden_);
      bend_row(inverse_, v, reach, bends_);
      for (int u = 0; u < w(); ++u) out.at(u, v) = units_of(reading(u, v), camera_);
    }
    return out;
  }

  const NoiseOptions& noise_;
  const Camera& camera_;
  const ExactDepth& view_;
  Rng rng_;
  Scenery scenery_;
  Image<float> inverse_;

 private:
  std::deque<SmoothNoise> fields_;  // a deque: they stay where they are
  std::vector<std::uint8_t> hidden_;
  std::vector<float> bends_;
};

}  // namespace vsgraphs
