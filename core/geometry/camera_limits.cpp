// Which cameras can be. The ranges are far beyond every camera sold, and near enough to keep numbers in their units.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "core/base/check.h"
#include "core/geometry/camera.h"
#include "core/geometry/lens_jacobian.h"

namespace vsgraphs {

namespace {

constexpr double widest_deg = 170, narrowest_deg = 5;  // fields of view along the longer side
constexpr double least_m = 0.01, farthest_m = 100;     // of depth
// Lenses are often calibrated without points in the corners, where the model then bends back. Of the way from the
// principal point to the image's rim, this much must be sound.
constexpr double sound_share = 0.8;

std::string text_of(double value, int digits = 6) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string list_of(const std::array<double, 5>& values) {
  std::string text;
  for (double value : values) {
    if (!text.empty()) text += ' ';
    text += text_of(value);
  }
  return text;
}

struct Range {
  double low, high;
  const char* unit;
};

// False for NaN, too.
void require_within(const std::string& name, double value, const Range& range, const std::string& cure) {
  require_input(value >= range.low && value <= range.high,
                "camera: " + name + " must be " + text_of(range.low) + " to " + text_of(range.high) +
                    range.unit + ", not " + text_of(value, 10) + " (" + cure + ")");
}

double focal_px(double side_px, double view_deg) {
  return side_px / 2 / std::tan(view_deg / 2 * std::numbers::pi / 180);
}

void check_pinhole(const Camera& c) {
  const Range sides{64, 8192, " px"};
  require_within("width", c.width, sides, "the size of the images");
  require_within("height", c.height, sides, "the size of the images");
  const double side = std::max(c.width, c.height);
  const std::string size = std::to_string(c.width) + "x" + std::to_string(c.height);
  const Range focal{focal_px(side, widest_deg), focal_px(side, narrowest_deg), " px"};
  const std::string view = "at " + size + " a view of " + text_of(widest_deg) + " to " +
                           text_of(narrowest_deg) +
                           " degrees; give focal lengths in pixels, of images of this size";
  require_within("fx", c.fx, focal, view);
  require_within("fy", c.fy, focal, view);
  require_within("fy", c.fy, {c.fx / 4, c.fx * 4, " px"}, "a pixel is about as high as wide, so near fx");
  // A part cut out of a larger image may lie beside its principal point.
  const std::string centre = "the principal point is near the middle of the image, of " + size + " here";
  require_within("cx", c.cx, {-0.25 * c.width, 1.25 * c.width, " px"}, centre);
  require_within("cy", c.cy, {-0.25 * c.height, 1.25 * c.height, " px"}, centre);
}

void check_depth(const Camera& c) {
  require_within("depth_scale", c.depth_scale, {1, 100000, ""},
                 "raw units in a metre: 1000 for millimetres, 5000 for TUM");
  require_within("depth_min_m", c.depth_min_m, {least_m, farthest_m, " m"}, "the nearest depth used");
  require_within("depth_max_m", c.depth_max_m, {least_m, farthest_m, " m"}, "the farthest depth used");
  require_input(c.depth_max_m > c.depth_min_m, "camera: depth_max_m must exceed depth_min_m, but is " +
                                                   text_of(c.depth_max_m) + " where that is " +
                                                   text_of(c.depth_min_m));
  const DepthNoise& noise = c.depth_noise;
  require_within("depth_noise.offset_m", noise.offset_m, {1e-6, 1, " m"}, "0.0012 for a Kinect");
  require_within("depth_noise.scale_per_m", noise.scale_per_m, {0, 1, " 1/m"}, "0.0019 for a Kinect");
  require_within("depth_noise.onset_m", noise.onset_m, {0, farthest_m, " m"}, "0.4 for a Kinect");
  require_within("depth_noise.alignment_m", noise.alignment_m, {0, 1, " m"}, "0.02 unless known better");
}

// Whether the lens shows on the way from the principal point to this pixel each direction once. Seen from the
// undistorted side, it does where the mapping keeps its orientation all the way.
bool is_sound(const Camera& c, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d centre(c.cx, c.cy), seen = centre + sound_share * (pixel - centre);
  const Eigen::Vector2d end = c.undistort(seen);
  if (!((c.distort(end) - seen).norm() < 0.1)) return false;
  const double slope = std::hypot((end.x() - c.cx) / c.fx, (end.y() - c.cy) / c.fy);
  if (!(slope < std::tan(widest_deg / 2 * std::numbers::pi / 180))) return false;
  constexpr int steps = 64;
  for (int i = 0; i <= steps; ++i) {
    const double at = static_cast<double>(i) / steps;
    if (!(distort_jacobian(c, centre + at * (end - centre)).determinant() > 0)) return false;
  }
  return true;
}

void check_lens(const Camera& c) {
  constexpr const char* names[] = {"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < c.distortion.size(); ++i) {
    require_within(std::string("distortion ") + names[i], c.distortion[i], {-1e6, 1e6, ""},
                   "the order is k1 k2 p1 p2 k3");
  }
  if (!c.distorted()) return;
  constexpr int steps = 8;  // along each side
  for (int i = 0; i < steps; ++i) {
    const double u = c.width - 1.0, v = c.height - 1.0, share = static_cast<double>(i) / steps;
    for (const Eigen::Vector2d& rim :
         {Eigen::Vector2d(share * u, 0), Eigen::Vector2d(u, share * v), Eigen::Vector2d(u - share * u, v),
          Eigen::Vector2d(0, v - share * v)}) {
      require_input(is_sound(c, rim),
                    "camera: distortion (k1 k2 p1 p2 k3) " + list_of(c.distortion) +
                        " folds the image over itself towards pixel (" + text_of(rim.x()) + ", " +
                        text_of(rim.y()) +
                        "); check its numbers, their order and that fx, fy are of the same calibration");
    }
  }
}

}  // namespace

void Camera::validate() const {
  check_pinhole(*this);
  check_lens(*this);
  require_within("fps", fps, {0.01, 10000, " Hz"}, "frames per second");
  check_depth(*this);
}

}  // namespace vsgraphs
