#include "core/geometry/plane.h"

#include <cmath>
#include <numbers>

namespace vsgraphs {

Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& n) {
  const double sign = std::copysign(1.0, n.z());
  const double a = -1.0 / (sign + n.z());
  const double b = n.x() * n.y() * a;
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) << 1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x();
  basis.col(1) << b, sign + n.y() * n.y() * a, -n.y();
  return basis;
}

AnchoredPlane AnchoredPlane::retract(const Eigen::Vector3d& delta) const {
  const Eigen::Vector3d v = tangent_basis(normal) * delta.head<2>();
  const double angle = v.norm();
  const double sinc = angle < 1e-4 ? 1 - angle * angle / 6 : std::sin(angle) / angle;
  AnchoredPlane moved = *this;
  moved.normal = (std::cos(angle) * normal + sinc * v).normalized();
  moved.offset_m += delta[2];
  return moved;
}

Eigen::Vector3d AnchoredPlane::local(const AnchoredPlane& other) const {
  const Eigen::Vector2d t = tangent_basis(normal).transpose() * other.normal;
  const double sine = t.norm(), cosine = normal.dot(other.normal);
  const double scale = sine < 1e-12 ? 1.0 : std::atan2(sine, cosine) / sine;
  Eigen::Vector3d delta;
  delta << scale * t, other.offset_m - offset_m;
  // The opposite normal is half a turn away in every direction: any one will do, none would be no difference.
  if (sine < 1e-12 && cosine < 0) delta.head<2>() = Eigen::Vector2d(std::numbers::pi, 0);
  return delta;
}

}  // namespace vsgraphs
