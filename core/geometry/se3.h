// Rigid transforms. Convention: `a_from_b` takes coordinates in b to coordinates in a; tangent vectors are
// (rho, phi) = (translation, rotation) and act on the right: T [+] xi = T * exp(xi), i.e. in b's own frame.
// Formulas: Barfoot, "State Estimation for Robotics" (2017), ch. 7; Sola et al., "A micro Lie theory" (2018).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/fields.h"

namespace vsgraphs {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d skew(const Eigen::Vector3d& v);

// SO(3) exponential and logarithm; exact to machine precision near 0, well defined up to pi.
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi);
Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);
// Left Jacobian of SO(3): exp(xi) of SE(3) has translation left_jacobian(phi) * rho.
Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& phi);

class Se3 {
 public:
  Se3() = default;
  Se3(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation)
      : rotation_(rotation), translation_(translation) {}
  static Se3 from_quaternion(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) {
    return {q.normalized().toRotationMatrix(), t};
  }
  static Se3 from_matrix(const Eigen::Matrix4d& m) {
    return {m.topLeftCorner<3, 3>(), m.topRightCorner<3, 1>()};
  }
  static Se3 exp(const Vector6d& xi);

  const Eigen::Matrix3d& rotation() const { return rotation_; }
  const Eigen::Vector3d& translation() const { return translation_; }
  // Unit quaternion with w >= 0, so that equal rotations print equally.
  Eigen::Quaterniond quaternion() const;
  Eigen::Matrix4d matrix() const;

  Se3 inverse() const { return {rotation_.transpose(), -(rotation_.transpose() * translation_)}; }
  Vector6d log() const;
  Se3 operator*(const Se3& other) const {
    return {rotation_ * other.rotation_, rotation_ * other.translation_ + translation_};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation_ * point + translation_; }
  Se3 retract(const Vector6d& xi) const { return (*this * exp(xi)).normalized(); }
  // The same transform with its rotation brought back to an exactly orthonormal matrix.
  Se3 normalized() const;
  bool finite() const { return rotation_.allFinite() && translation_.allFinite(); }

  template <FieldsOf<Se3> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.rotation_, v.translation_);
  }

 private:
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

// Angle of the rotation, rad in [0, pi].
double rotation_angle(const Eigen::Matrix3d& rotation);

}  // namespace vsgraphs
