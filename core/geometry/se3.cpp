#include "core/geometry/se3.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace vsgraphs {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

namespace {

// sin(t)/t and (1-cos(t))/t^2 and (t-sin(t))/t^3, with their series where the quotients lose digits.
struct Coefficients {
  double a, b, c;
};

Coefficients coefficients(double theta2) {
  if (theta2 < 1e-4) {
    return {1 - theta2 / 6 * (1 - theta2 / 20), 0.5 - theta2 / 24 * (1 - theta2 / 30),
            1.0 / 6 - theta2 / 120 * (1 - theta2 / 42)};
  }
  const double theta = std::sqrt(theta2);
  return {std::sin(theta) / theta, (1 - std::cos(theta)) / theta2,
          (theta - std::sin(theta)) / (theta2 * theta)};
}

}  // namespace

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi) {
  const Coefficients k = coefficients(phi.squaredNorm());
  const Eigen::Matrix3d s = skew(phi);
  return Eigen::Matrix3d::Identity() + k.a * s + k.b * s * s;
}

Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& phi) {
  const Coefficients k = coefficients(phi.squaredNorm());
  const Eigen::Matrix3d s = skew(phi);
  return Eigen::Matrix3d::Identity() + k.b * s + k.c * s * s;
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
  // Through the quaternion: stable at 0 and at pi alike.
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double n = q.vec().norm();
  if (n < 1e-10) return 2.0 * q.vec();
  return (2.0 * std::atan2(n, q.w()) / n) * q.vec();
}

Se3 Se3::exp(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  return {so3_exp(phi), so3_left_jacobian(phi) * xi.head<3>()};
}

Vector6d Se3::log() const {
  Vector6d xi;
  const Eigen::Vector3d phi = so3_log(rotation_);
  xi.tail<3>() = phi;
  xi.head<3>() = so3_left_jacobian(phi).partialPivLu().solve(translation_);
  return xi;
}

Eigen::Quaterniond Se3::quaternion() const {
  Eigen::Quaterniond q(rotation_);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

Eigen::Matrix4d Se3::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation_;
  m.topRightCorner<3, 1>() = translation_;
  return m;
}

Se3 Se3::normalized() const { return {quaternion().toRotationMatrix(), translation_}; }

double rotation_angle(const Eigen::Matrix3d& rotation) {
  // atan2 keeps its digits near 0 and pi, where acos of the trace loses them.
  const Eigen::Vector3d axis2(rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0),
                              rotation(1, 0) - rotation(0, 1));
  return std::atan2(axis2.norm(), rotation.trace() - 1.0);
}

}  // namespace vsgraphs
