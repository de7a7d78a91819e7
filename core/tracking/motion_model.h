// Where the camera should be now: constant velocity, believed as far as it was measured.
// A Kalman filter (Kalman, 1960) of the velocity, whose random walk dies down where nothing measures it (Ornstein-Uhlenbeck).
#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/principal_axes.h"
#include "core/geometry/se3.h"

namespace vsgraphs {

class MotionModel {
 public:
  // Constant velocity, scaled by time; the last pose where only one is known. Extrapolates over half a second at the most.
  Se3 predict(const Se3& world_from_last, double seconds) const {
    if (!known_) return world_from_last;
    return world_from_last.retract(twist_per_s_ * std::min(seconds, max_extrapolation_s));
  }

  // `information`: what was measured of the pose now (tangent on its right), the inverse of its covariance; that of the previous pose
  // is remembered. A velocity is a difference of poses: what a few matches say of it is mostly noise, and where only a prediction held
  // one of the two it says nothing.
  void update(const Se3& world_from_previous, const Se3& world_from_now, double seconds,
              const Matrix6d& information) {
    if (seconds <= 0) return;
    const Vector6d measured = (world_from_previous.inverse() * world_from_now).log() / seconds;
    const double fading = std::exp(-seconds / fading_s);
    twist_per_s_ *= fading;
    if (known_) {
      covariance_ = fading * fading * covariance_;
      covariance_.diagonal() += seconds * acceleration();
    }
    const Matrix6d known = information + nothing_known();
    const Matrix6d gained =
        seconds * seconds * inverse6(inverse6(known) + inverse6(known_ ? previous_information_ : known));
    previous_information_ = known;
    covariance_ = inverse6(inverse6(covariance_) + gained);
    twist_per_s_ += covariance_ * gained * (measured - twist_per_s_);
    known_ = true;
  }
  void forget() { *this = MotionModel{}; }
  bool known() const { return known_; }

 private:
  // Beyond this a straight extrapolation is worth less than standing still.
  static constexpr double max_extrapolation_s = 0.5;
  static constexpr double fading_s = 5.0;
  // What a hand does to a camera: changes of velocity of 0.5 m/s and 1 rad/s within a third of a second are common.
  static Vector6d acceleration() {
    return (Vector6d() << 0.8, 0.8, 0.8, 3, 3, 3).finished();
  }  // m^2/s^3, rad^2/s^3

  // 10 m, 10 rad: keeps what no measurement holds invertible.
  static Matrix6d nothing_known() { return 0.01 * Matrix6d::Identity(); }

  bool known_ = false;
  Matrix6d previous_information_ = Matrix6d::Zero();
  Vector6d twist_per_s_ = Vector6d::Zero();
  Matrix6d covariance_ = 4.0 * Matrix6d::Identity();  // of a camera of which nothing is known: 2 m/s, 2 rad/s
};

}  // namespace vsgraphs
