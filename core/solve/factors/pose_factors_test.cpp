#include "core/base/rng.h"
#include "core/solve/factors/factor_jacobian_test.h"
#include "core/solve/factors/jacobian_test.h"
#include "core/solve/factors/point_to_plane.h"
#include "core/solve/factors/pose_prior.h"
#include "core/solve/factors/relative_pose.h"

namespace vsgraphs {
namespace {

Matrix6d some_sqrt_information(Rng& rng) {
  Matrix6d s = Matrix6d::Identity() * 3;
  for (int i = 0; i < 36; ++i) s(i / 6, i % 6) += 0.5 * rng.normal();
  return s;
}

void check(const DenseFactor& factor, const std::vector<Se3>& poses) {
  expect_factor_jacobians(factor, poses, {});
}

// Errors from none, through the series' range, to a turn of 2.5 rad.
constexpr double radians[] = {0, 1e-9, 1e-5, 0.05, 0.0999, 0.1001, 0.5, 1.4};

TEST(PosePrior, JacobianAgreesWithDifferences) {
  Rng rng(1, "pose_factors_test", 0);
  for (double angle : radians) {
    const Se3 pose = Se3::exp(tangent(rng, 2, 1));
    const Se3 prior = pose * Se3::exp(tangent(rng, angle > 0 ? 1 : 0, angle));
    check(PosePrior({VariableKind::pose, 0}, prior, some_sqrt_information(rng)), {pose});
  }
}

TEST(RelativePose, JacobiansAgreeWithDifferences) {
  Rng rng(2, "pose_factors_test", 0);
  for (double angle : radians) {
    const Se3 a = Se3::exp(tangent(rng, 2, 1)), b = Se3::exp(tangent(rng, 2, 1));
    const Se3 measured = a.inverse() * b * Se3::exp(tangent(rng, angle > 0 ? 1 : 0, angle));
    check(
        RelativePose({VariableKind::pose, 0}, {VariableKind::pose, 1}, measured, some_sqrt_information(rng)),
        {a, b});
  }
}

TEST(RelativePose, IsZeroAtTheMeasurement) {
  Rng rng(3, "pose_factors_test", 0);
  const std::vector<Se3> poses{Se3::exp(tangent(rng, 2, 1)), Se3::exp(tangent(rng, 2, 1))};
  const StructureVariables none;
  const RelativePose factor({VariableKind::pose, 0}, {VariableKind::pose, 1}, poses[0].inverse() * poses[1],
                            Matrix6d::Identity());
  FactorRows rows;
  factor.resize(rows);
  ASSERT_TRUE(factor.evaluate({poses, none}, false, rows));
  EXPECT_LT(rows.residual.norm(), 1e-12);
}

TEST(RelativePose, MarkersAndPosesAreTheSameToIt) {
  const std::vector<Se3> poses{Se3::exp(Vector6d::Constant(0.3))};
  StructureVariables structures;
  structures.markers = {Se3::exp(Vector6d::Constant(-0.2))};
  const RelativePose factor({VariableKind::pose, 0}, {VariableKind::marker, 0},
                            poses[0].inverse() * structures.markers[0], Matrix6d::Identity());
  FactorRows rows;
  factor.resize(rows);
  ASSERT_TRUE(factor.evaluate({poses, structures}, true, rows));
  EXPECT_LT(rows.residual.norm(), 1e-12);
  EXPECT_TRUE(rows.jacobians[1].isApprox(Matrix6d::Identity(), 1e-9));
}

TEST(RelativePose, JacobiansOfAMarkerAgreeWithDifferences) {
  Rng rng(6, "pose_factors_test", 0);
  for (double angle : radians) {
    const std::vector<Se3> poses{Se3(), Se3::exp(tangent(rng, 2, 1))};
    StructureVariables structures;
    structures.markers = {Se3(), Se3(), Se3::exp(tangent(rng, 2, 1))};
    const Se3 measured =
        poses[1].inverse() * structures.markers[2] * Se3::exp(tangent(rng, angle > 0 ? 1 : 0, angle));
    expect_factor_jacobians(RelativePose({VariableKind::pose, 1}, {VariableKind::marker, 2}, measured,
                                         some_sqrt_information(rng), {2}),
                            poses, structures);
  }
}

TEST(PointToPlaneFactor, JacobianAgreesWithDifferences) {
  Rng rng(4, "pose_factors_test", 0);
  for (int i = 0; i < 20; ++i) {
    const Se3 pose = Se3::exp(tangent(rng, 2, 1));
    const PointToPlane m{Eigen::Vector3d(rng.normal(), rng.normal(), 2),
                         Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized(), 0.7, 30};
    Vector6d jacobian;
    point_to_plane(pose, m, &jacobian);
    const auto at = [&](const Eigen::VectorXd& xi) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, point_to_plane(pose.retract(xi), m, nullptr));
    };
    expect_jacobian(jacobian.transpose(), at, 1e-7, 1e-3);
  }
}

TEST(Adjoint, CarriesTangentsThroughTheTransform) {
  Rng rng(5, "pose_factors_test", 0);
  const Se3 t = Se3::exp(tangent(rng, 2, 1));
  const Vector6d xi = tangent(rng, 1, 0.5);
  const Matrix6d adjoint = se3_adjoint(t);
  EXPECT_TRUE((t * Se3::exp(xi) * t.inverse()).matrix().isApprox(Se3::exp(adjoint * xi).matrix(), 1e-12));
}

}  // namespace
}  // namespace vsgraphs
