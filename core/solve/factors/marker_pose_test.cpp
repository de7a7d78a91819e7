#include "core/solve/factors/marker_pose.h"

#include "core/base/rng.h"
#include "core/solve/factors/factor_jacobian_test.h"

namespace vsgraphs {
namespace {

TEST(MarkerPose, JacobiansAgreeWithDifferences) {
  Rng rng(1, "marker_pose_test", 0);
  for (double angle : {0.0, 1e-9, 1e-5, 0.05, 0.5, 1.4}) {
    const std::vector<Se3> poses{Se3(), Se3::exp(tangent(rng, 2, 1))};
    StructureVariables structures;
    structures.markers = {Se3(), Se3(), Se3::exp(tangent(rng, 2, 1))};
    const Se3 seen =
        poses[1].inverse() * structures.markers[2] * Se3::exp(tangent(rng, angle > 0 ? 1 : 0, angle));
    Matrix6d root = 3 * Matrix6d::Identity();
    for (int i = 0; i < 36; ++i) root(i / 6, i % 6) += 0.5 * rng.normal();
    expect_factor_jacobians(MarkerPose(1, 2, seen, root), poses, structures);
  }
}

TEST(MarkerPose, IsZeroWhereItWasSeenAndGrowsByItsSigmas) {
  const std::vector<Se3> poses{Se3::exp(Vector6d::Constant(0.3))};
  const Se3 seen(Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitX()).toRotationMatrix(), {0.1, 0.2, 2});
  StructureVariables structures;
  structures.markers = {poses[0] * seen};
  const MarkerPose factor(0, 0, seen, 100 * Matrix6d::Identity());
  EXPECT_LT(residual_of(factor, poses, structures).norm(), 1e-9);
  structures.markers = {poses[0] * seen * Se3(Eigen::Matrix3d::Identity(), {0.01, 0, 0})};
  const Eigen::VectorXd off = residual_of(factor, poses, structures);
  EXPECT_NEAR(off[0], 1, 1e-9);
  EXPECT_NEAR(off.norm(), 1, 1e-9);
}

}  // namespace
}  // namespace vsgraphs
