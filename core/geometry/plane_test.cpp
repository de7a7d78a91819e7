#include "core/geometry/plane.h"

#include <gtest/gtest.h>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

Eigen::Vector3d some_direction(Rng& rng) {
  return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

AnchoredPlane some_plane(Rng& rng) {
  return {some_direction(rng), {rng.normal(), rng.normal(), rng.normal()}, rng.normal()};
}

TEST(TangentBasis, IsOrthonormalEverywhere) {
  Rng rng(1, "plane_test", 0);
  std::vector<Eigen::Vector3d> normals = {Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(),
                                          Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitY(),
                                          Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ()};
  for (int i = 0; i < 100; ++i) normals.push_back(some_direction(rng));
  for (const Eigen::Vector3d& n : normals) {
    Eigen::Matrix3d all;
    all << tangent_basis(n), n;
    EXPECT_TRUE((all.transpose() * all).isIdentity(1e-12)) << n.transpose();
  }
}

TEST(AnchoredPlane, LocalUndoesRetract) {
  Rng rng(1, "plane_test", 1);
  for (int i = 0; i < 100; ++i) {
    const AnchoredPlane plane = some_plane(rng);
    const Eigen::Vector3d delta(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    EXPECT_TRUE(plane.local(plane.retract(delta)).isApprox(delta, 1e-9));
  }
  const AnchoredPlane plane = some_plane(rng);
  EXPECT_TRUE(plane.local(plane).isZero());
}

// A solver that knows one tilt only lets a plane swing about the other.
TEST(AnchoredPlane, BothTiltsTurnTheNormalEachAboutItsOwnAxis) {
  Rng rng(1, "plane_test", 2);
  for (int i = 0; i < 20; ++i) {
    const AnchoredPlane plane = some_plane(rng);
    const Eigen::Vector3d first = plane.retract({0.1, 0, 0}).normal,
                          second = plane.retract({0, 0.1, 0}).normal;
    EXPECT_NEAR(std::acos(first.dot(plane.normal)), 0.1, 1e-9);
    EXPECT_NEAR(std::acos(second.dot(plane.normal)), 0.1, 1e-9);
    EXPECT_NEAR((first - plane.normal).dot(second - plane.normal), 0, 1e-4);
    EXPECT_EQ(plane.retract({0.1, 0.1, 0}).anchor, plane.anchor);
  }
}

TEST(AnchoredPlane, TurningMovesItNotAtItsAnchor) {
  AnchoredPlane plane{Eigen::Vector3d::UnitX(), {100, 50, 0}, 0};
  const AnchoredPlane turned = plane.retract({0.05, 0.05, 0});
  EXPECT_NEAR(turned.signed_distance(plane.anchor), 0, 1e-12);
  EXPECT_GT(std::abs(turned.d() - plane.d()), 0.5) << "measured at the origin it moves by metres";
}

TEST(AnchoredPlane, IsTheSameSurfaceWhereverItIsAnchored) {
  Rng rng(1, "plane_test", 3);
  const AnchoredPlane plane = some_plane(rng);
  const AnchoredPlane moved = plane.anchored_at({3, -2, 7});
  EXPECT_EQ(moved.anchor, Eigen::Vector3d(3, -2, 7));
  EXPECT_NEAR(moved.d(), plane.d(), 1e-12);
  const Eigen::Vector3d point(1, 2, 3);
  EXPECT_NEAR(moved.signed_distance(point), plane.signed_distance(point), 1e-12);
  EXPECT_NEAR(plane.normal.dot(point) + plane.d(), plane.signed_distance(point), 1e-12);
  EXPECT_NEAR(plane.signed_distance(plane.project(point)), 0, 1e-12);
}

TEST(AnchoredPlane, KeepsItsDistancesAndItsSideInAnotherFrame) {
  Rng rng(1, "plane_test", 4);
  const AnchoredPlane plane = some_plane(rng);
  Vector6d tangent;
  tangent << 1, 2, 3, 0.3, -0.2, 0.5;
  const Se3 target_from_source = Se3::exp(tangent);
  const AnchoredPlane there = plane.transformed(target_from_source);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d point = some_direction(rng);
    EXPECT_NEAR(there.signed_distance(target_from_source * point), plane.signed_distance(point), 1e-12);
  }
}

}  // namespace
}  // namespace vsgraphs
