#include "core/geometry/camera.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "bindings/bind.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace vsgraphs {

namespace {

// A number too large for the field is too large for a camera; validate() says so.
int side_of(std::int64_t px) {
  return static_cast<int>(
      std::clamp<std::int64_t>(px, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

}  // namespace

void bind_camera(nb::module_& m) {
  using Noise = std::array<double, 3>;
  nb::class_<Camera>(
      m, "Camera",
      "Pinhole camera with Brown-Conrady distortion and the depth sensor's properties.\n\n"
      "Pixels have their centres at integers; axes: x right, y down, z forward. Lengths in metres.")
      .def(
          "__init__",
          [](Camera* self, std::int64_t width, std::int64_t height, double fx, double fy, double cx,
             double cy, std::array<double, 5> distortion, double fps, double depth_scale, double depth_min_m,
             double depth_max_m, std::vector<std::uint16_t> invalid_depth, Noise noise,
             double depth_alignment_m) {
            Camera camera;
            camera.width = side_of(width);
            camera.height = side_of(height);
            camera.fx = fx;
            camera.fy = fy;
            camera.cx = cx;
            camera.cy = cy;
            camera.distortion = distortion;
            camera.fps = fps;
            camera.depth_scale = depth_scale;
            camera.depth_min_m = depth_min_m;
            camera.depth_max_m = depth_max_m;
            camera.invalid_depth = std::move(invalid_depth);
            camera.depth_noise = {noise[0], noise[1], noise[2], depth_alignment_m};
            camera.validate();
            new (self) Camera(std::move(camera));
          },
          "width"_a, "height"_a, "fx"_a, "fy"_a, "cx"_a, "cy"_a, nb::kw_only(),
          "distortion"_a = std::array<double, 5>{}, "fps"_a = 30.0, "depth_scale"_a = 5000.0,
          "depth_min_m"_a = 0.3, "depth_max_m"_a = 8.0,
          "invalid_depth"_a = std::vector<std::uint16_t>{0, 65535},
          "depth_noise"_a = Noise{0.0012, 0.0019, 0.4}, "depth_alignment_m"_a = 0.02,
          "Args:\n"
          "  width, height: image size, px.\n"
          "  fx, fy, cx, cy: focal lengths and principal point, px.\n"
          "  distortion: k1, k2, p1, p2, k3.\n"
          "  fps: nominal frame rate, Hz.\n"
          "  depth_scale: raw depth units per metre.\n"
          "  depth_min_m, depth_max_m: readings outside are not used.\n"
          "  invalid_depth: raw values that mean \"no reading\".\n"
          "  depth_noise: offset_m, scale_per_m, onset_m of sigma(z) = offset + scale (z - onset)^2.\n"
          "  depth_alignment_m: what the delay and the offset between colour and depth add to that.\n\n"
          "Raises InputError naming the first value that makes no sense.")
      .def_rw("width", &Camera::width)
      .def_rw("height", &Camera::height)
      .def_rw("fx", &Camera::fx)
      .def_rw("fy", &Camera::fy)
      .def_rw("cx", &Camera::cx)
      .def_rw("cy", &Camera::cy)
      .def_rw("distortion", &Camera::distortion)
      .def_rw("fps", &Camera::fps)
      .def_rw("depth_scale", &Camera::depth_scale)
      .def_rw("depth_min_m", &Camera::depth_min_m)
      .def_rw("depth_max_m", &Camera::depth_max_m)
      .def_rw("invalid_depth", &Camera::invalid_depth)
      .def_prop_rw(
          "depth_noise",
          [](const Camera& c) {
            return Noise{c.depth_noise.offset_m, c.depth_noise.scale_per_m, c.depth_noise.onset_m};
          },
          [](Camera& c, Noise n) { c.depth_noise = {n[0], n[1], n[2], c.depth_noise.alignment_m}; })
      .def_prop_rw(
          "depth_alignment_m", [](const Camera& c) { return c.depth_noise.alignment_m; },
          [](Camera& c, double value) { c.depth_noise.alignment_m = value; })
      .def("validate", &Camera::validate, "Raises InputError naming the first value that makes no sense.")
      .def("__repr__", [](const Camera& c) {
        return "Camera(" + std::to_string(c.width) + "x" + std::to_string(c.height) +
               ", fx=" + std::to_string(c.fx) + ", fy=" + std::to_string(c.fy) +
               ", cx=" + std::to_string(c.cx) + ", cy=" + std::to_string(c.cy) + ")";
      });
}

}  // namespace vsgraphs
