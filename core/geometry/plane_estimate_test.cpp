#include "core/geometry/plane_estimate.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

Eigen::Vector3d unit(Rng& rng) {
  return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

// A plane in front of a camera at the origin, facing it, anchored on its surface.
AnchoredPlane surface(Rng& rng) {
  const Eigen::Vector3d centre(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(1, 3));
  Eigen::Vector3d normal = (Eigen::Vector3d(0, 0, -1) + 0.6 * unit(rng)).normalized();
  return {normal, centre, 0};
}

PlaneEstimate some_estimate(Rng& rng) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = 30 * rng.normal();
  return {surface(rng), root.transpose() * root};
}

TEST(PlaneEstimate, InformationFollowsThePlaneIntoAnotherFrame) {
  // Whatever plane is compared, it disagrees with the estimate by the same amount in both frames.
  Rng rng(6, "plane_estimate_test", 0);
  for (int i = 0; i < 50; ++i) {
    const PlaneEstimate seen = some_estimate(rng);
    Vector6d xi;
    for (int k = 0; k < 6; ++k) xi[k] = 2 * rng.normal();
    const Se3 motion = Se3::exp(xi);
    const PlaneEstimate moved = seen.transformed(motion);
    const AnchoredPlane other = seen.plane.retract(0.3 * unit(rng));
    const Eigen::Vector3d before = seen.plane.local(other),
                          after = moved.plane.local(other.transformed(motion));
    const double chi2 = before.dot(seen.information * before);
    EXPECT_NEAR(after.dot(moved.information * after), chi2, 1e-9 * (1 + chi2));
    EXPECT_TRUE(moved.transformed(motion.inverse()).information.isApprox(seen.information, 1e-9));
  }
}

TEST(PlaneEstimate, FrameMotionMovesThePlaneAsItsJacobianSays) {
  Rng rng(7, "plane_estimate_test", 0);
  const AnchoredPlane plane = surface(rng);
  Vector6d xi;
  for (int k = 0; k < 6; ++k) xi[k] = 1e-6 * rng.normal();
  // The frame moves by exp(xi): in it, the plane moves the other way.
  const Eigen::Vector3d moved =
      plane.local(plane.transformed(Se3::exp(xi).inverse()).anchored_at(plane.anchor));
  EXPECT_LT((moved - plane_by_frame(plane) * xi).norm(), 1e-10);
}

TEST(PlaneEstimate, FrameErrorCapsTheInformation) {
  Rng rng(8, "plane_estimate_test", 0);
  const PlaneEstimate seen = some_estimate(rng);
  EXPECT_TRUE(seen.inflated({}).information.isApprox(seen.information, 1e-12));
  // Against the covariances, added.
  const FrameTolerance frame{0.02, 0.01};
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(4e-4), Eigen::Vector3d::Constant(1e-4);
  const auto by_frame = plane_by_frame(seen.plane);
  const Eigen::Matrix3d sum =
      seen.information.inverse() + by_frame * variance.asDiagonal() * by_frame.transpose();
  EXPECT_TRUE(seen.inflated(frame).information.isApprox(sum.inverse(), 1e-6));
  // What was not known stays unknown, and nothing becomes infinite.
  PlaneEstimate line = seen;
  line.information = Eigen::Vector3d(1e6, 0, 1e6).asDiagonal();
  const Eigen::Matrix3d left = line.inflated(frame).information;
  EXPECT_LT(left.col(1).norm(), 1e-6);
  EXPECT_LT(left(2, 2), 1 / 4e-4);
  EXPECT_GT(left(2, 2), 100);
}

TEST(PlaneEstimate, TurnsByHalfAreNoAgreement) {
  const AnchoredPlane plane{Eigen::Vector3d::UnitX(), {1, 2, 3}, 0};
  const AnchoredPlane opposite{-Eigen::Vector3d::UnitX(), {1, 2, 3}, 0};
  EXPECT_NEAR(plane.local(opposite).norm(), 3.14159265, 1e-6);
}

}  // namespace
}  // namespace vsgraphs
