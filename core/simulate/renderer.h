// Renders a scene as an RGB-D camera would see it, frame by frame in any order. Geometry (depth, class and instance) is
// exact at the pixel's centre; colour is averaged over several rays per pixel and, with blur, over the exposure time. About
// 15 frames/s clean and 8 with noise at 640x480 on one 2020s core.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/se3.h"
#include "core/simulate/scene.h"
#include "core/simulate/visibility.h"

namespace vsgraphs {

// Each effect can be switched off by itself; `none()` switches all off ("clean").
struct NoiseOptions {
  std::uint64_t seed = 0;  // another seed, another draw of the same noise

  bool depth_quantisation = true;  // depth from disparity in steps, with noise on the disparity
  double baseline_m = 0.075;       // of projector and camera
  double disparity_step_px = 0.125;
  double disparity_sigma_px = 0.043;  // correlated over a few pixels, as block matching leaves it

  bool depth_holes = true;  // no reading at depth edges, grazing angles, far off, on glass and out of range
  double depth_min_m = 0.35, depth_max_m = 6.0;
  double grazing_deg = 78;  // angle from the normal where readings begin to fail

  bool exposure = true;  // slow changes of brightness
  double exposure_amplitude = 0.07;

  bool motion_blur = true;
  double exposure_time_s = 0.010;

  bool image_noise = true;
  double image_sigma = 2.4;  // grey levels, mostly alike in all channels

  static NoiseOptions none();
  void validate() const;  // InputError naming the option
};

struct RenderedFrame {
  double time_s = 0;      // since the start of the walk
  Se3 world_from_camera;  // at that time (the middle of the exposure)
  Image<Rgb> rgb;
  Image<std::uint16_t> depth;     // camera.depth_scale units per metre along the optical axis; 0: no reading
  Image<std::uint8_t> label;      // SceneClass
  Image<std::uint16_t> instance;  // index into Scene::instances
};

class Renderer {
 public:
  // Keeps a reference to the scene. The camera must be free of distortion (InputError).
  Renderer(const Scene& scene, const Camera& camera, const NoiseOptions& noise);

  int frame_count() const { return scene_.frame_count(); }
  // Frame `index` of the walk at the plan's rate, 0..frame_count() - 1. Same arguments, same bytes.
  RenderedFrame render(int index);

 private:
  View view_at(double time_s, double offset_u, double offset_v) const;
  void render_geometry(RenderedFrame& frame, Image<float>& incidence);
  void render_colour(RenderedFrame& frame, int index);
  void shade(int sample);

  const Scene& scene_;
  Camera camera_;
  NoiseOptions noise_;
  VisibilityBuffer buffer_;
  std::vector<float> colour_;  // sum over rays, three floats per pixel
};

}  // namespace vsgraphs
