#include "core/solve/structure_variables.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/rng.h"
#include "core/solve/factors/jacobian_test.h"

namespace vsgraphs {
namespace {

// What every manifold of the solver must satisfy at `x`: local(x, x) = 0, and retract and local undo each other, for
// steps from 1e-12 to `largest`.
template <typename T, typename Retract, typename Local>
void expect_manifold(const T& x, int dof, double largest, Retract retract, Local local, Rng& rng) {
  EXPECT_LT(local(x, x).norm(), 1e-12);
  for (double size : {0.0, 1e-12, 1e-9, 1e-6, 9e-5, 1.1e-4, 1e-2, 1.0}) {
    Eigen::VectorXd delta(dof);
    for (int i = 0; i < dof; ++i) delta[i] = rng.normal();
    delta *= std::min(size, largest) / delta.norm();
    const Eigen::VectorXd back = local(x, retract(x, delta));
    EXPECT_LT((back - delta).norm(), 1e-14 + 1e-9 * delta.norm()) << "size " << size;
  }
}

Eigen::Vector3d unit(Rng& rng) {
  return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

const Eigen::Vector3d special_normals[] = {{0, 0, 1},
                                           {0, 0, -1},
                                           {1, 0, 0},
                                           {0, -1, 0},
                                           Eigen::Vector3d(1e-9, 0, -1).normalized(),
                                           Eigen::Vector3d(1e-5, -1e-5, -1).normalized()};

TEST(TangentBasis, IsOrthonormalEverywhere) {
  Rng rng(1, "structure_variables_test", 0);
  std::vector<Eigen::Vector3d> normals(std::begin(special_normals), std::end(special_normals));
  for (int i = 0; i < 100; ++i) normals.push_back(unit(rng));
  for (const Eigen::Vector3d& n : normals) {
    Eigen::Matrix3d frame;
    frame << tangent_basis(n), n;
    EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-12) << n.transpose();
  }
}

TEST(AnchoredPlane, IsAManifold) {
  Rng rng(2, "structure_variables_test", 0);
  const auto retract = [](const AnchoredPlane& p, const Eigen::VectorXd& d) { return p.retract(d); };
  const auto local = [](const AnchoredPlane& a, const AnchoredPlane& b) -> Eigen::VectorXd {
    return a.local(b);
  };
  for (const Eigen::Vector3d& n : special_normals)
    expect_manifold<AnchoredPlane>({n, {1, 2, 3}, 0.2}, 3, 1, retract, local, rng);
  for (int i = 0; i < 20; ++i)
    expect_manifold<AnchoredPlane>({unit(rng), {1, 2, 3}, -4}, 3, 1, retract, local, rng);
}

TEST(PoseVariable, IsAManifold) {
  Rng rng(3, "structure_variables_test", 0);
  const auto retract = [](const Se3& t, const Eigen::VectorXd& d) { return t.retract(d); };
  const auto local = [](const Se3& a, const Se3& b) -> Eigen::VectorXd { return (a.inverse() * b).log(); };
  EXPECT_EQ(Se3().retract(Vector6d::Zero()).matrix(), Se3().matrix());
  expect_manifold<Se3>(Se3(), 6, 1, retract, local, rng);
}

TEST(AnchoredPlane, NormalStaysUnitAndAnchorStays) {
  AnchoredPlane p{Eigen::Vector3d(1, 2, 2) / 3, {5, 6, 7}, 0.1};
  for (int i = 0; i < 1000; ++i) p = p.retract({0.3, -0.2, 0.01});
  EXPECT_NEAR(p.normal.norm(), 1, 1e-14);
  EXPECT_EQ(p.anchor, Eigen::Vector3d(5, 6, 7));
  EXPECT_NEAR(p.offset_m, 10.1, 1e-9);
}

TEST(AnchoredPlane, TurningTheNormalDoesNotMoveThePlaneAtItsAnchor) {
  const AnchoredPlane p{Eigen::Vector3d::UnitX(), {20, 30, 1}, 0};
  EXPECT_NEAR(p.retract({0.1, 0.1, 0}).signed_distance({20, 30, 1}), 0, 1e-14);
  EXPECT_NEAR(p.d(), -20, 1e-14);
}

TEST(AnchoredPlane, SignedDistanceHasTheExpectedDerivative) {
  Rng rng(4, "structure_variables_test", 0);
  const AnchoredPlane p{unit(rng), {1, -2, 3}, 0.3};
  const Eigen::Vector3d x(2, 1, 4);
  Eigen::RowVector3d jacobian;
  jacobian << (x - p.anchor).transpose() * tangent_basis(p.normal), 1;
  expect_jacobian(
      jacobian,
      [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(1, p.retract(d).signed_distance(x));
      },
      1e-8, 1e-3);
}

}  // namespace
}  // namespace vsgraphs
