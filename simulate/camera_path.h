// The way a person carries the camera: way-points joined at walking speed, corners rounded (in place and in view
// direction) by a Gaussian in time, plus the small movement of steps and hands. The pose is a function of time alone, twice
// differentiable, so that any instant within an exposure can be rendered.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/geometry/se3.h"
#include "simulate/plan.h"

namespace vsgraphs {

// A way-point with everything decided: place (m) and view direction (rad; yaw from +x towards +y, pitch up positive).
struct ViewPoint {
  Eigen::Vector3d position{0, 0, 0};
  double yaw_rad = 0, pitch_rad = 0;
  double pause_s = 0;
};

class CameraPath {
 public:
  CameraPath() = default;
  // `points`: at least one; yaw turns the short way round between neighbours.
  CameraPath(const PathPlan& plan, std::vector<ViewPoint> points, std::uint64_t seed);

  double duration_s() const { return duration_s_; }
  int frame_count(double fps) const;
  // Optical axes (x right, y down, z forward). Times outside 0..duration are held at the ends.
  Se3 world_from_camera(double time_s) const;
  // The way-point passed last at this time (for messages).
  int waypoint_before(double time_s) const;

 private:
  struct Sway {  // one sinusoid of the hand's movement
    int axis;    // 0..2 position in the world, 3..5 rotation in the camera
    double amplitude, frequency_hz, phase;
    bool from_steps;  // grows with walking speed
  };
  using Sample = Eigen::Matrix<double, 5, 1>;  // position, yaw, pitch
  Sample smooth(double time_s) const;

  std::vector<double> arrival_s_;  // at each way-point
  std::vector<Sample> control_;    // of a uniform cubic B-spline, one each step_s
  std::vector<double> speed_;      // share of walking speed at the same instants
  std::vector<Sway> sways_;
  double duration_s_ = 0;
};

}  // namespace vsgraphs
