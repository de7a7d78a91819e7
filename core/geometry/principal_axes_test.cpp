#include "core/geometry/principal_axes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vsgraphs {
namespace {

TEST(PrincipalAxes, WeakestAxisIsThatOfTheSmallestEigenvalue) {
  const Eigen::Vector3d weak = Eigen::Vector3d(1, 2, -2) / 3;
  const Eigen::Matrix3d matrix = 5 * Eigen::Matrix3d::Identity() - 4 * weak * weak.transpose();
  EXPECT_NEAR(std::abs(weakest_axis(matrix).dot(weak)), 1, 1e-12);
}

TEST(PrincipalAxes, SmallestEigenvalueOfATurnedDiagonal) {
  Eigen::Matrix2d turn;
  turn << 0.8, -0.6, 0.6, 0.8;
  const Eigen::Vector2d values(3, 7);
  EXPECT_NEAR(smallest_eigenvalue(turn * values.asDiagonal() * turn.transpose()), 3, 1e-12);
}

TEST(PrincipalAxes, WeakDirectionsAreThoseHardlyMeasured) {
  Vector6d sigma;
  sigma << 0.001, 0.2, 0.001, 0.001, 0.001, 0.1;
  const Matrix6d information = sigma.cwiseInverse().cwiseAbs2().asDiagonal();
  const Matrix6d weak = weak_directions(information, 0.05);
  Vector6d expected = Vector6d::Zero();
  expected[1] = expected[5] = 1;
  EXPECT_LT((weak - Matrix6d(expected.asDiagonal())).norm(), 1e-12);
  EXPECT_LT(weak_directions(1e6 * Matrix6d::Identity(), 0.05).norm(), 1e-12);
}

}  // namespace
}  // namespace vsgraphs
