#include "core/solve/factors/reprojection.h"

#include "core/base/rng.h"
#include "core/solve/factors/jacobian_test.h"

namespace vsgraphs {
namespace {

const Intrinsics intrinsics;

Se3 some_pose(Rng& rng) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = rng.normal();
  return Se3::exp(xi);
}

template <int Rows>
void check(const Eigen::Vector3d& in_camera, Rng& rng) {
  const Se3 pose = some_pose(rng);
  const Eigen::Vector3d point = pose * in_camera;
  const ReprojectionMeasurement m{300, 200, 0.4, 0.7, 90};
  ReprojectionRows<Rows> rows;
  ASSERT_TRUE(reprojection(intrinsics, pose, point, m, rows));
  const auto moved = [&](const Se3& p, const Eigen::Vector3d& x) -> Eigen::VectorXd {
    ReprojectionRows<Rows> at;
    EXPECT_TRUE(reprojection(intrinsics, p, x, m, at));
    return at.residual;
  };
  const double step = 1e-4 * in_camera.z();
  expect_jacobian(
      rows.by_pose, [&](const Eigen::VectorXd& xi) { return moved(pose.retract(xi), point); }, 1e-7, step);
  expect_jacobian(
      rows.by_point, [&](const Eigen::VectorXd& d) { return moved(pose, point + d); }, 1e-7, step);
}

TEST(Reprojection, JacobiansAgreeWithDifferences) {
  Rng rng(1, "reprojection_test", 0);
  for (int i = 0; i < 50; ++i) {
    const double z = rng.uniform(0.3, 8);
    const Eigen::Vector3d p(z * rng.uniform(-0.6, 0.6), z * rng.uniform(-0.5, 0.5), z);
    check<3>(p, rng);
    check<2>(p, rng);
  }
}

TEST(Reprojection, JacobiansHoldNearTheCameraPlane) {
  Rng rng(2, "reprojection_test", 0);
  check<3>({0.02, -0.01, min_projection_depth_m + 0.003}, rng);
  check<2>({0.02, -0.01, min_projection_depth_m + 0.003}, rng);
}

TEST(Reprojection, ResidualIsWhitenedDifference) {
  const ReprojectionMeasurement m{319.5 + 52.5, 239.5, 0.25, 2.0, 10.0};
  ReprojectionRows<3> rows;
  ASSERT_TRUE(reprojection(intrinsics, Se3(), Eigen::Vector3d(0, 0, 2), m, rows));
  EXPECT_NEAR(rows.residual[0], -105, 1e-9);
  EXPECT_NEAR(rows.residual[1], 0, 1e-9);
  EXPECT_NEAR(rows.residual[2], 2.5, 1e-9);
}

TEST(Reprojection, RefusesPointsBehindOrOnTheCameraPlane) {
  ReprojectionRows<3> rows;
  rows.residual.setConstant(7);
  for (double z : {min_projection_depth_m - 1e-6, 0.0, -1.0, std::nan("")}) {
    EXPECT_FALSE(reprojection(intrinsics, Se3(), Eigen::Vector3d(0.1, 0.1, z), {}, rows)) << z;
  }
  EXPECT_EQ(rows.residual[0], 7);
}

}  // namespace
}  // namespace vsgraphs
