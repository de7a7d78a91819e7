#include "simulate/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/check.h"
#include "core/base/rng.h"

namespace vsgraphs {
namespace {

constexpr double step_s = 0.05;
constexpr double pi = std::numbers::pi;

double wrapped(double angle) { return std::remainder(angle, 2 * pi); }

double leg_duration(const PathPlan& plan, const ViewPoint& a, const ViewPoint& b) {
  const double walk = (b.position - a.position).norm() / plan.speed;
  const double turn = std::abs(b.yaw_rad - a.yaw_rad) / (plan.turn_rate * pi / 180);
  const double nod = std::abs(b.pitch_rad - a.pitch_rad) / (plan.turn_rate * pi / 180);
  return std::max({walk, turn, nod});
}

// Optical axes of a camera looking along (yaw, pitch) with a level horizon.
Eigen::Matrix3d look_rotation(double yaw, double pitch) {
  const Eigen::Vector3d forward(std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch),
                                std::sin(pitch));
  const Eigen::Vector3d right(std::sin(yaw), -std::cos(yaw), 0);
  Eigen::Matrix3d r;
  r << right, forward.cross(right), forward;
  return r;
}

}  // namespace

CameraPath::CameraPath(const PathPlan& plan, std::vector<ViewPoint> points, std::uint64_t seed) {
  VSG_INVARIANT(!points.empty());
  if (plan.closed) points.push_back(points.front());
  for (std::size_t i = 1; i < points.size(); ++i)
    points[i].yaw_rad = points[i - 1].yaw_rad + wrapped(points[i].yaw_rad - points[i - 1].yaw_rad);

  // Knots of the piecewise linear walk, at rest for a moment at both ends so that it starts and stops softly.
  const double rest_s = 2 * plan.smooth_s;
  std::vector<double> times;
  std::vector<Sample> knots;
  double time = rest_s;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) time += leg_duration(plan, points[i - 1], points[i]);
    Sample knot;
    knot << points[i].position, points[i].yaw_rad, points[i].pitch_rad;
    arrival_s_.push_back(time);
    times.push_back(time), knots.push_back(knot);
    time += points[i].pause_s;
    times.push_back(time), knots.push_back(knot);
  }
  duration_s_ = time + rest_s;

  const auto walk = [&](double t) -> Sample {
    const auto next = std::upper_bound(times.begin(), times.end(), t);
    if (next == times.begin()) return knots.front();
    if (next == times.end()) return knots.back();
    const auto i = static_cast<std::size_t>(next - times.begin());
    const double share = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return knots[i - 1] + share * (knots[i] - knots[i - 1]);
  };
  const int reach = static_cast<int>(std::ceil(3 * plan.smooth_s / step_s));
  const int count = static_cast<int>(std::ceil(duration_s_ / step_s)) + 4;
  for (int i = -1; i < count; ++i) {
    Sample sum = Sample::Zero();
    double total = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double x = plan.smooth_s > 0 ? k * step_s / plan.smooth_s : 0;
      const double weight = std::exp(-0.5 * x * x);
      sum += weight * walk((i + k) * step_s);
      total += weight;
    }
    control_.push_back(sum / total);
  }
  for (std::size_t i = 0; i < control_.size(); ++i) {
    const Sample& a = control_[i > 0 ? i - 1 : i];
    const Sample& b = control_[std::min(i + 1, control_.size() - 1)];
    speed_.push_back(std::min(1.5, (b - a).head<3>().norm() / (2 * step_s) / plan.speed));
  }

  // Amplitudes: a few millimetres of bob at step frequency, a slow drift of the arm, tenths of a degree of tremor.
  Rng rng(seed, "camera_path", 0);
  const auto sway = [&](int axis, double amplitude, double low_hz, double high_hz, bool from_steps) {
    sways_.push_back(
        {axis, plan.shake * amplitude, rng.uniform(low_hz, high_hz), rng.uniform(0, 2 * pi), from_steps});
  };
  sway(2, 0.005, 1.6, 1.9, true);
  for (int axis = 0; axis < 3; ++axis) sway(axis, 0.007, 0.12, 0.35, false);
  for (int axis = 0; axis < 3; ++axis) sway(axis, 0.0012, 1.0, 2.2, true);
  for (int axis = 3; axis < 6; ++axis) sway(axis, 0.7 * pi / 180, 0.15, 0.4, false);
  for (int axis = 3; axis < 6; ++axis) sway(axis, 0.15 * pi / 180, 1.2, 2.6, true);
}

int CameraPath::frame_count(double fps) const {
  return static_cast<int>(std::floor(duration_s_ * fps + 1e-9)) + 1;
}

CameraPath::Sample CameraPath::smooth(double time_s) const {
  const double x = std::clamp(time_s, 0.0, duration_s_) / step_s;
  const auto i = static_cast<std::size_t>(x);
  const double t = x - static_cast<double>(i);
  const double a = (1 - t) * (1 - t) * (1 - t), b = 4 - 6 * t * t + 3 * t * t * t;
  const double c = 1 + 3 * t + 3 * t * t - 3 * t * t * t, d = t * t * t;
  return (a * control_[i] + b * control_[i + 1] + c * control_[i + 2] + d * control_[i + 3]) / 6;
}

Se3 CameraPath::world_from_camera(double time_s) const {
  const Sample s = smooth(time_s);
  const double x = std::clamp(time_s, 0.0, duration_s_) / step_s;
  const auto i = static_cast<std::size_t>(x);
  const double share = x - static_cast<double>(i);
  const double walking = (1 - share) * speed_[i + 1] + share * speed_[i + 2];
  Vector6d move = Vector6d::Zero();
  for (const Sway& w : sways_)
    move[w.axis] +=
        (w.from_steps ? walking : 1.0) * w.amplitude * std::sin(2 * pi * w.frequency_hz * time_s + w.phase);
  return {look_rotation(s[3], s[4]) * so3_exp(move.tail<3>()), s.head<3>() + move.head<3>()};
}

int CameraPath::waypoint_before(double time_s) const {
  const auto next = std::upper_bound(arrival_s_.begin(), arrival_s_.end(), time_s);
  return std::max(0, static_cast<int>(next - arrival_s_.begin()) - 1);
}

}  // namespace vsgraphs
