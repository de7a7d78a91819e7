// What the simulated camera does to an exact image, with every effect a switch or a number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "simulate/lens.h"

namespace vsgraphs {

// `none()` switches everything off ("clean"); `of(sensor)` is what a camera that can be bought does (docs/simulator.md).
struct NoiseOptions {
  std::uint64_t seed = 0;  // another seed, another draw of the same noise

  std::string sensor = "classic";  // how depth is measured; see sensor_names()

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

  double softness_px = 0;  // standard deviation of the blur of optics and colour mosaic

  bool auto_exposure = false;  // longer exposure in dark rooms, then more gain and with it more noise
  double exposure_max_s = 0.033;
  double rolling_shutter_s = 0;  // from the first row's exposure to the last one's
  double depth_delay_s = 0;      // depth is measured so much later than the colour image of the same stamp
  double misregistration_u_px = 0,
         misregistration_v_px = 0;  // depth at (u, v) is that of the colour at (u + .., v + ..)
  double misregistration_baseline_m =
      0;  // depth is seen from so far to the right: near things are off by more, fx x this / depth
  double border_right = 0, border_top = 0;  // shares of the image that have no depth
  double roll_deg = 0;  // of the mount, clockwise as the camera sees it: 90 portrait, 180 upside down
  Lens lens;

  static NoiseOptions none();
  static NoiseOptions of(const std::string& sensor);  // InputError naming those there are
  void validate() const;                              // InputError naming the option
  bool depth_apart() const {  // whether depth is not taken with the colour image, pixel for pixel
    return rolling_shutter_s > 0 || depth_delay_s != 0 || misregistration_u_px != 0 ||
           misregistration_v_px != 0 || misregistration_baseline_m != 0;
  }
};

std::vector<std::string> sensor_names();
// The image a sensor's depth is given on where a plan says nothing: colour and depth share it.
Camera sensor_camera(const std::string& sensor);

}  // namespace vsgraphs
