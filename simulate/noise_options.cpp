#include "simulate/noise_options.h"

#include <cmath>

#include "core/base/check.h"
#include "simulate/depth_sensors.h"

namespace vsgraphs {

NoiseOptions NoiseOptions::none() {
  NoiseOptions off;
  off.sensor = "clean";
  off.depth_quantisation = off.depth_holes = off.exposure = off.motion_blur = off.image_noise = false;
  return off;
}

void NoiseOptions::validate() const {
  const auto within = [](double value, double low, double high, const char* name) {
    require_input(
        std::isfinite(value) && value >= low && value <= high,
        std::string("noise.") + name + ": must lie in " + std::to_string(low) + ".." + std::to_string(high));
  };
  within(baseline_m, 0.001, 2, "baseline_m");
  within(disparity_step_px, 1e-3, 4, "disparity_step_px");
  within(disparity_sigma_px, 0, 4, "disparity_sigma_px");
  within(depth_min_m, 0, 10, "depth_min_m");
  within(depth_max_m, 0.1, 13, "depth_max_m");
  within(grazing_deg, 0, 90, "grazing_deg");
  within(exposure_amplitude, 0, 0.9, "exposure_amplitude");
  within(exposure_time_s, 0, 0.2, "exposure_time_s");
  within(image_sigma, 0, 60, "image_sigma");
  within(softness_px, 0, 1.5, "softness_px");
  within(exposure_max_s, 0, 0.2, "exposure_max_s");
  within(rolling_shutter_s, 0, 0.2, "rolling_shutter_s");
  within(depth_delay_s, -1, 1, "depth_delay_s");
  within(misregistration_u_px, -50, 50, "misregistration_u_px");
  within(misregistration_v_px, -50, 50, "misregistration_v_px");
  within(misregistration_baseline_m, -0.2, 0.2, "misregistration_baseline_m");
  within(border_right, 0, 0.5, "border_right");
  within(border_top, 0, 0.5, "border_top");
  within(roll_deg, -360, 360, "roll_deg");
  lens.validate();
  static_cast<void>(depth_sensor(sensor));
}

NoiseOptions NoiseOptions::of(const std::string& name) {
  NoiseOptions options;
  if (name == "clean") return none();
  const DepthSensor& sensor = depth_sensor(name);
  options.sensor = name;
  if (sensor.adjust != nullptr) sensor.adjust(options);
  return options;
}

Camera sensor_camera(const std::string& name) {
  Camera camera;  // 640 x 480, 525
  camera.depth_min_m = 0.35, camera.depth_max_m = 6.0;
  const DepthSensor& sensor = depth_sensor(name);
  if (sensor.width == 0) return camera;
  camera.width = sensor.width, camera.height = sensor.height;
  camera.fx = camera.fy = sensor.focal_px;
  camera.cx = 0.5 * (sensor.width - 1), camera.cy = 0.5 * (sensor.height - 1);
  return camera;
}

std::vector<std::string> sensor_names() {
  std::vector<std::string> names;
  for (const DepthSensor& sensor : depth_sensors()) names.emplace_back(sensor.name);
  return names;
}

Image<std::uint16_t> sense(const NoiseOptions& noise, const Camera& camera, int frame,
                           const ExactDepth& view) {
  return depth_sensor(noise.sensor).sense(noise, camera, frame, view);
}

}  // namespace vsgraphs
