#include "core/geometry/se3_jacobian.h"

#include <cmath>

namespace vsgraphs {
namespace {

// Lower-left coupling block of the left Jacobian of SE(3).
Eigen::Matrix3d coupling(const Eigen::Vector3d& rho, const Eigen::Vector3d& phi) {
  const double t2 = phi.squaredNorm();
  double a, b, c;
  if (t2 < 1e-2) {  // series: the quotients lose all digits near zero
    a = 1.0 / 6 - t2 / 120 * (1 - t2 / 42 * (1 - t2 / 72));
    b = 1.0 / 24 - t2 / 720 * (1 - t2 / 56 * (1 - t2 / 90));
    c = 1.0 / 120 - t2 / 2520 * (1 - t2 / 48 * (1 - t2 / 82.5));
  } else {
    const double t = std::sqrt(t2), s = std::sin(t), k = std::cos(t);
    a = (t - s) / (t2 * t);
    b = (t2 + 2 * k - 2) / (2 * t2 * t2);
    c = (2 * t - 3 * s + t * k) / (2 * t2 * t2 * t);
  }
  const Eigen::Matrix3d p = skew(phi), r = skew(rho);
  const Eigen::Matrix3d pr = p * r, rp = r * p, prp = pr * p;
  return 0.5 * r + a * (pr + rp + prp) + b * (p * pr + rp * p - 3 * prp) + c * (prp * p + p * prp);
}

}  // namespace

Matrix6d se3_right_jacobian_inverse(const Vector6d& log_of_transform) {
  // The right Jacobian at xi is the left one at -xi.
  const Eigen::Vector3d rho = -log_of_transform.head<3>(), phi = -log_of_transform.tail<3>();
  const Eigen::Matrix3d inverse = so3_left_jacobian(phi).inverse();
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = inverse;
  jacobian.bottomRightCorner<3, 3>() = inverse;
  jacobian.topRightCorner<3, 3>() = -inverse * coupling(rho, phi) * inverse;
  return jacobian;
}

Matrix6d se3_adjoint(const Se3& transform) {
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = transform.rotation();
  adjoint.bottomRightCorner<3, 3>() = transform.rotation();
  adjoint.topRightCorner<3, 3>() = skew(transform.translation()) * transform.rotation();
  return adjoint;
}

}  // namespace vsgraphs
