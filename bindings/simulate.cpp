#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/simulate_plan.h"
#include "bindings/simulate_truth.h"
#include "simulate/renderer.h"
#include "simulate/truth.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace vsgraphs {
namespace {

// A view of an image inside a frame; it keeps the frame alive.
template <typename T, typename Pixel>
nb::ndarray<nb::numpy, const T> pixels_of(nb::handle owner, const Image<Pixel>& image) {
  const auto h = static_cast<std::size_t>(image.height), w = static_cast<std::size_t>(image.width);
  const T* data = reinterpret_cast<const T*>(image.pixels.data());
  if constexpr (sizeof(Pixel) == 3 * sizeof(T))
    return nb::ndarray<nb::numpy, const T>(data, {h, w, 3}, owner);
  else
    return nb::ndarray<nb::numpy, const T>(data, {h, w}, owner);
}

template <typename T, auto member>
auto image_property() {
  return [](nb::handle self) { return pixels_of<T>(self, nb::cast<const RenderedFrame&>(self).*member); };
}

void bind_frame(nb::module_& m) {
  nb::class_<RenderedFrame>(m, "RenderedFrame",
                            "One rendered RGB-D frame with its truth. Arrays are read-only views.")
      .def_ro("time_s", &RenderedFrame::time_s, "Seconds since the start of the walk.")
      .def_prop_ro(
          "world_from_camera",
          [](const RenderedFrame& f) {
            std::vector<double> rows;
            append_rows(rows, f.world_from_camera);
            return to_numpy(std::move(rows), {4, 4});
          },
          nb::rv_policy::move, "(4, 4) float64; camera axes x right, y down, z forward.")
      .def_prop_ro(
          "quaternion_xyzw",
          [](const RenderedFrame& f) {
            const Eigen::Vector4d q = f.world_from_camera.quaternion().coeffs();
            return std::array<double, 4>{q[0], q[1], q[2], q[3]};
          },
          "The rotation as x, y, z, w with w >= 0.")
      .def_prop_ro("rgb", image_property<std::uint8_t, &RenderedFrame::rgb>(), "(H, W, 3) uint8")
      .def_prop_ro("depth", image_property<std::uint16_t, &RenderedFrame::depth>(),
                   "(H, W) uint16, Camera.depth_scale units per metre; 0: no reading")
      .def_prop_ro("label", image_property<std::uint8_t, &RenderedFrame::label>(),
                   "(H, W) uint8, see scene_classes()")
      .def_prop_ro("instance", image_property<std::uint16_t, &RenderedFrame::instance>(), "(H, W) uint16");
}

void bind_noise(nb::module_& m) {
  nb::class_<NoiseOptions>(m, "NoiseOptions", "Effects of the simulated sensor; each has its own switch.")
      .def(nb::init<>())
      .def_static("none", &NoiseOptions::none, "Everything switched off.")
      .def("validate", &NoiseOptions::validate, "Raises InputError naming the option out of range.")
      .def_rw("seed", &NoiseOptions::seed, "another seed, another draw")
      .def_rw("depth_quantisation", &NoiseOptions::depth_quantisation)
      .def_rw("baseline_m", &NoiseOptions::baseline_m)
      .def_rw("disparity_step_px", &NoiseOptions::disparity_step_px)
      .def_rw("disparity_sigma_px", &NoiseOptions::disparity_sigma_px)
      .def_rw("depth_holes", &NoiseOptions::depth_holes)
      .def_rw("depth_min_m", &NoiseOptions::depth_min_m)
      .def_rw("depth_max_m", &NoiseOptions::depth_max_m)
      .def_rw("grazing_deg", &NoiseOptions::grazing_deg)
      .def_rw("exposure", &NoiseOptions::exposure)
      .def_rw("exposure_amplitude", &NoiseOptions::exposure_amplitude)
      .def_rw("motion_blur", &NoiseOptions::motion_blur)
      .def_rw("exposure_time_s", &NoiseOptions::exposure_time_s)
      .def_rw("image_noise", &NoiseOptions::image_noise)
      .def_rw("image_sigma", &NoiseOptions::image_sigma)
      .def_static("of", &NoiseOptions::of, "sensor"_a,
                  "What a sensor does, by its name; InputError names those there are.")
      .def_ro("sensor", &NoiseOptions::sensor, "how depth is measured")
      .def_rw("auto_exposure", &NoiseOptions::auto_exposure)
      .def_rw("exposure_max_s", &NoiseOptions::exposure_max_s)
      .def_rw("rolling_shutter_s", &NoiseOptions::rolling_shutter_s)
      .def_rw("depth_delay_s", &NoiseOptions::depth_delay_s)
      .def_rw("misregistration_u_px", &NoiseOptions::misregistration_u_px)
      .def_rw("misregistration_v_px", &NoiseOptions::misregistration_v_px)
      .def_rw("misregistration_baseline_m", &NoiseOptions::misregistration_baseline_m)
      .def_rw("softness_px", &NoiseOptions::softness_px)
      .def_rw("border_right", &NoiseOptions::border_right)
      .def_rw("border_top", &NoiseOptions::border_top)
      .def_rw("roll_deg", &NoiseOptions::roll_deg)
      .def_prop_rw(
          "lens", [](const NoiseOptions& o) { return o.lens.model; },
          [](NoiseOptions& o, const std::string& model) { o.lens.model = model; })
      .def_prop_rw(
          "lens_k", [](const NoiseOptions& o) { return o.lens.k; },
          [](NoiseOptions& o, const std::vector<double>& k) { o.lens.k = k; });
  m.def("sensor_names", &sensor_names, "Values of NoiseOptions.of().");
  m.def("sensor_camera", &sensor_camera, "sensor"_a, "The camera of a sensor, where a plan names none.");
}

}  // namespace

void bind_simulate(nb::module_& m) {
  bind_plan(m);
  bind_noise(m);
  bind_frame(m);
  nb::class_<Scene>(m, "Scene", "A plan built: surfaces, truth and camera path. Never changes.")
      .def_prop_ro("frame_count", &Scene::frame_count)
      .def_prop_ro("duration_s", [](const Scene& s) { return s.path.duration_s(); })
      .def_prop_ro("face_count", [](const Scene& s) { return s.faces.size(); })
      .def_prop_ro("plan", [](const Scene& s) { return s.plan; })
      .def(
          "poses",
          [](const Scene& s, const std::vector<double>& times_s) {
            std::vector<double> rows;
            for (const double t : times_s) append_rows(rows, s.path.world_from_camera(t));
            return to_numpy(std::move(rows), {times_s.size(), 4, 4});
          },
          "times_s"_a,
          "(n, 4, 4) float64: world_from_camera at seconds since the start, held before and after the walk.");
  m.def("build_scene", &build_scene, "plan"_a, nb::call_guard<nb::gil_scoped_release>(),
        "Raises InputError naming the plan's key that cannot be built or walked.");
  nb::class_<Renderer>(m, "Renderer", "Renders frames of a scene in any order; use one per thread.")
      .def(nb::init<const Scene&, const Camera&, const NoiseOptions&>(), "scene"_a, "camera"_a, "noise"_a,
           nb::keep_alive<1, 2>())
      .def("render", &Renderer::render, "index"_a, nb::call_guard<nb::gil_scoped_release>(),
           "Frame `index` of the walk at the plan's rate. Same arguments, same bytes. The GIL is released.")
      .def(
          "pose",
          [](const Renderer& r, int index) {
            const Se3 pose = r.pose(index);
            std::vector<double> rows;
            append_rows(rows, pose);
            const Eigen::Vector4d q = pose.quaternion().coeffs();
            return nb::make_tuple(to_numpy(std::move(rows), {4, 4}),
                                  std::array<double, 4>{q[0], q[1], q[2], q[3]});
          },
          "index"_a, "world_from_camera (4, 4) and its rotation as x, y, z, w of frame `index`.");
  nb::class_<ObservationCounter>(m, "ObservationCounter",
                                 "Counts which surfaces were seen, in any order of frames.")
      .def(nb::init<const Scene&>(), "scene"_a, nb::keep_alive<1, 2>())
      .def(
          "add",
          [](ObservationCounter& c, const RenderedFrame& f) {
            c.add(f.instance, f.world_from_camera.translation());
          },
          "frame"_a)
      .def_prop_ro("frames", &ObservationCounter::frames);
  m.def("scene_truth", &scene_truth, "scene"_a, "seen"_a,
        "The truth as nested dicts and lists in the shape of scene_gt.json; see docs/simulator.md.");
  m.def(
      "scene_classes",
      [] {
        nb::dict classes;
        for (std::size_t i = 0; i < scene_class_names.size(); ++i)
          classes[std::string(scene_class_names[i]).c_str()] = i;
        return classes;
      },
      "{class name: value in label images}");
  m.def("furniture_kinds", &furniture_kinds, "Values of a box's \"kind\".");
  m.def("poster_kinds", &poster_kinds, "Values of a poster's \"kind\".");
  m.def("floor_kinds", &floor_kinds, "Values of a room's \"floor\".");
}

}  // namespace vsgraphs
