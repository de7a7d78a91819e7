// Pinhole camera with Brown-Conrady distortion (Brown 1966; the model of the TUM benchmark) and the
// depth sensor's properties. Pixel centres are at integers; camera axes x right, y down, z forward.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/fields.h"

namespace vsgraphs {

// Standard deviation of depth: offset_m + scale * (z - onset_m)^2. Defaults: Kinect v1 (Nguyen, Izadi, Lovell,
// "Modeling Kinect Sensor Noise", 3DIMPVT 2012, axial noise).
struct DepthNoise {
  double offset_m = 0.0012;
  double scale_per_m = 0.0019;
  double onset_m = 0.4;
  // What lies between a depth reading and the colour feature it is given to: the two images are taken some
  // milliseconds and some pixels apart, and that error is common to a whole frame, so no number of readings
  // averages it away. Without it a moving camera lags behind its features (measured: docs/benchmarks.md).
  double alignment_m = 0.02;

  // Of the reading itself.
  double sigma_m(double depth_m) const {
    const double d = depth_m - onset_m;
    return offset_m + scale_per_m * d * d;
  }
  // Of the reading as a measurement of the colour feature's depth.
  double feature_sigma_m(double depth_m) const { return std::hypot(sigma_m(depth_m), alignment_m); }
};
template <FieldsOf<DepthNoise> T>
void visit_fields(T& v, auto& field) {
  auto& [offset_m, scale_per_m, onset_m, alignment_m] = v;
  field(offset_m, scale_per_m, onset_m, alignment_m);
}

struct Camera {
  int width = 640;
  int height = 480;
  double fx = 525.0, fy = 525.0, cx = 319.5, cy = 239.5;
  std::array<double, 5> distortion{};  // k1 k2 p1 p2 k3
  double fps = 30.0;                   // nominal rate, Hz

  double depth_scale = 5000.0;  // raw depth units per metre
  double depth_min_m = 0.3;     // nearer or farther readings are not used
  double depth_max_m = 8.0;
  std::vector<std::uint16_t> invalid_depth{0, 65535};  // raw values that mean "no reading"
  DepthNoise depth_noise;

  bool distorted() const {
    for (double k : distortion)
      if (k != 0.0) return true;
    return false;
  }

  // Undistorted pixel of a point in the camera frame; the caller checks z > 0.
  Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    const double iz = 1.0 / p.z();
    return {fx * p.x() * iz + cx, fy * p.y() * iz + cy};
  }
  // Point in the camera frame from an undistorted pixel and its depth (along z, m).
  Eigen::Vector3d unproject(double u, double v, double depth_m) const {
    return {(u - cx) / fx * depth_m, (v - cy) / fy * depth_m, depth_m};
  }
  bool contains(double u, double v) const { return u >= 0 && v >= 0 && u <= width - 1 && v <= height - 1; }

  // Pixel as the lens shows it -> pixel of the ideal pinhole, and back.
  Eigen::Vector2d undistort(const Eigen::Vector2d& distorted_px) const;
  Eigen::Vector2d distort(const Eigen::Vector2d& undistorted_px) const;

  // Throws InputError naming the first field that makes no sense (sizes, focal lengths, scales, ranges, NaN).
  void validate() const;
};
template <FieldsOf<Camera> T>
void visit_fields(T& v, auto& field) {
  auto& [width, height, fx, fy, cx, cy, distortion, fps, depth_scale, depth_min_m, depth_max_m, invalid_depth,
         depth_noise] = v;
  field(width, height, fx, fy, cx, cy, distortion, fps, depth_scale, depth_min_m, depth_max_m, invalid_depth,
        depth_noise);
}

}  // namespace vsgraphs
