#include "core/solve/factors/plane_difference.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "core/base/check.h"

namespace vsgraphs {

Eigen::Matrix3d plane_sqrt_information(const Eigen::Matrix3d& information) {
  require_input(information.allFinite(),
                "plane factor: the information matrix holds a value that is not finite");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information);
  return axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * axes.eigenvectors().transpose();
}

Eigen::Vector2d tilt_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             Eigen::Matrix<double, 2, 3>* by_to) {
  constexpr double opposite = 1e-9, series = 1e-3;
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(from);
  const Eigen::Vector2d t = basis.transpose() * to;
  const double sine = t.norm(), cosine = from.dot(to);
  if (sine < opposite && cosine < 0) {
    if (by_to) *by_to << -basis.col(0).transpose(), Eigen::RowVector3d::Zero();
    return {std::numbers::pi, 0};
  }
  const double angle = std::atan2(sine, cosine);
  const bool small = sine < series && cosine > 0;
  const double scale = small ? 1 + sine * sine / 6 : angle / sine;
  if (by_to) {
    // d(scale) = (t.dt) (cos sin - angle) / sin^3 - from.d(to)
    const double bend = small ? -2.0 / 3 - sine * sine / 5 : (cosine * sine - angle) / (sine * sine * sine);
    *by_to = scale * basis.transpose() + t * (bend * (basis * t) - from).transpose();
  }
  return scale * t;
}

}  // namespace vsgraphs
