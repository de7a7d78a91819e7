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

TEST(PrincipalAxes, InverseOfAnInformation) {
  Matrix6d root = Matrix6d::Identity();
  for (int i = 0; i < 5; ++i) root(i, i + 1) = 0.3 * (i + 1);
  const Matrix6d information = 1e4 * root * root.transpose();
  EXPECT_LT((inverse6(information) * information - Matrix6d::Identity()).norm(), 1e-9);
}

}  // namespace
}  // namespace vsgraphs
