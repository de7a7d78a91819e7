// Renders a scene as an RGB-D camera would see it, frame by frame in any order. Geometry (depth, class and instance) is
// exact at the pixel's centre; colour is averaged over several rays per pixel and, with blur, over the exposure time.
// Speed: docs/simulator.md.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/se3.h"
#include "simulate/noise_options.h"
#include "simulate/scene.h"
#include "simulate/shading.h"
#include "simulate/visibility.h"

namespace vsgraphs {

struct RenderedFrame {
  double time_s = 0;      // since the start of the walk
  Se3 world_from_camera;  // at that time (the middle of the exposure)
  Image<Rgb> rgb;
  Image<std::uint16_t> depth;     // camera.depth_scale units per metre along the optical axis; 0: no reading
  Image<std::uint8_t> label;      // SceneClass
  Image<std::uint16_t> instance;  // index into Scene::instances
};

struct ExactDepth;

class Renderer {
 public:
  // Keeps a reference to the scene. Lenses are `noise.lens`'s: the camera must be free of distortion (InputError).
  Renderer(const Scene& scene, const Camera& camera, const NoiseOptions& noise);

  int frame_count() const { return scene_.frame_count(); }
  // Frame `index` of the walk at the plan's rate, 0..frame_count() - 1. Same arguments, same bytes.
  RenderedFrame render(int index);
  Se3 pose(int index) const;  // of that frame's camera in the world

 private:
  struct Exposure {
    double time_s = 0;  // how long light is gathered
    float gain = 1;
    double sigma = 0;  // of the image's noise, grey levels
  };
  struct Moment {  // when and how rows are looked at
    double time_s = 0, offset_u = 0, offset_v = 0;
    bool rolling = false;
    double right_m = 0;  // the camera stands so far to the right of the one whose poses are given
  };
  const Camera& pinhole() const { return lens_.empty() ? camera_ : lens_.front().pinhole(); }
  Se3 camera_at(double time_s) const { return scene_.path.world_from_camera(time_s) * mount_; }
  View view_at(const Moment& moment) const;
  void draw_rows(const Moment& moment, int begin, int end);
  template <typename Look>
  void each_band(bool rolling, const Look& look) const;
  // Fills `out`, its depth only where that has an image, and the instances where they are wanted.
  void look_at_geometry(const Moment& moment, ExactDepth& out, Image<std::uint16_t>* instance);
  void look_at_row(int v, ExactDepth& out, Image<std::uint16_t>* instance) const;
  int look_at_run(int first, int v, ExactDepth& out, Image<std::uint16_t>* instance) const;
  void look_at_pixel(int u, int v, ExactDepth& out, Image<std::uint16_t>* instance) const;
  void look_at_depth(ExactDepth& out, const Moment& moment, Image<std::uint16_t>* instance);
  void cut_border(Image<std::uint16_t>& depth) const;
  Exposure exposure_at(double time_s);
  static Camera meter_of(const Camera& camera);
  double brightness_at(double time_s);
  void render_colour(RenderedFrame& frame, int index);
  void shade(int sample, int begin, int end);
  void shade_row(int v, int sample, const ColourRow& colour);
  void shade_bent_row(int v, int sample, const ColourRow& colour);
  void tint_row(int v, int sample, const ColourRow& colour) const;
  bool two_rays_do(const Exposure& exposure, double time_s) const;

  const Scene& scene_;
  Camera camera_;
  NoiseOptions noise_;
  Se3 mount_;
  std::vector<LensMap> lens_;  // one, or none
  VisibilityBuffer buffer_;
  Camera meter_;  // a small image for automatic exposure
  VisibilityBuffer meter_buffer_;
  std::vector<float> colour_;  // sum over rays, see ColourRow
  std::vector<float> ray_;     // of one row, where glass has to be looked through
};

}  // namespace vsgraphs
