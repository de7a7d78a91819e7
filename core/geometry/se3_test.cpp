#include "core/geometry/se3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

using std::numbers::pi;

Eigen::Vector3d axis(Rng& rng) {
  return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

Vector6d tangent(const Eigen::Vector3d& rho, const Eigen::Vector3d& phi) {
  Vector6d xi;
  xi.head<3>() = rho;
  xi.tail<3>() = phi;
  return xi;
}

// Around the switch to series (1e-2 in the angle), near 0 and near a half turn.
const std::vector<double> angles{0,   1e-300, 1e-12, 1e-9,      1e-6,      1e-4,      0.00999,   0.01001,
                                 0.1, 1.0,    3.0,   pi - 1e-3, pi - 1e-6, pi - 1e-9, pi - 1e-12};

TEST(So3, LogarithmUndoesTheExponential) {
  Rng rng(1, "se3_test", 0);
  for (double angle : angles) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d phi = angle * axis(rng);
      const Eigen::Vector3d back = so3_log(so3_exp(phi));
      // At a half turn the axis may come back reversed.
      const double error =
          angle > pi - 1e-5 ? std::min((back - phi).norm(), (back + phi).norm()) : (back - phi).norm();
      EXPECT_LT(error, 4e-14 * std::min(1.0, angle + 1e-2)) << angle;
    }
  }
}

TEST(So3, ExponentialIsARotationAndAgreesWithAngleAxis) {
  Rng rng(2, "se3_test", 0);
  for (double angle : angles) {
    const Eigen::Vector3d a = axis(rng);
    const Eigen::Matrix3d r = so3_exp(angle * a);
    EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_LT((r - Eigen::AngleAxisd(angle, a).toRotationMatrix()).norm(), 1e-14) << angle;
    EXPECT_NEAR(rotation_angle(r), angle, 1e-14 + 4e-16 * angle) << angle;
  }
}

TEST(So3, HalfTurnsAboutTheAxesHaveALogarithm) {
  for (int k = 0; k < 3; ++k) {
    Eigen::Matrix3d r = -Eigen::Matrix3d::Identity();
    r(k, k) = 1;
    const Eigen::Vector3d phi = so3_log(r);
    EXPECT_NEAR(phi.norm(), pi, 1e-12);
    EXPECT_NEAR(std::abs(phi[k]), pi, 1e-12);
  }
}

TEST(So3, LeftJacobianIsTheDerivativeOfTheExponential) {
  Rng rng(3, "se3_test", 0);
  for (double angle : {0.0, 1e-8, 1e-3, 0.00999, 0.01001, 0.5, 2.0, 3.0}) {
    const Eigen::Vector3d phi = angle * axis(rng);
    const Eigen::Matrix3d jacobian = so3_left_jacobian(phi);
    const Eigen::Matrix3d undo = so3_exp(phi).transpose();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d e = 1e-4 * Eigen::Vector3d::Unit(k);
      const Eigen::Vector3d difference =
          (so3_log(so3_exp(phi + e) * undo) - so3_log(so3_exp(phi - e) * undo)) / 2e-4;
      EXPECT_LT((difference - jacobian.col(k)).norm(), 1e-8) << angle;
    }
  }
}

TEST(Se3, LogarithmUndoesTheExponential) {
  Rng rng(4, "se3_test", 0);
  for (double angle : angles) {
    if (angle > 3.1) continue;  // the axis may reverse, and the translation's part with it
    for (double length : {0.0, 1e-9, 1.0, 100.0}) {
      const Vector6d xi = tangent(length * axis(rng), angle * axis(rng));
      EXPECT_LT((Se3::exp(xi).log() - xi).norm(), 1e-13 * (1 + length)) << angle << " " << length;
    }
  }
}

TEST(Se3, InverseAndProductAreThoseOfTheMatrices) {
  Rng rng(5, "se3_test", 0);
  for (int i = 0; i < 20; ++i) {
    const Se3 a = Se3::exp(tangent(3 * axis(rng), 2 * axis(rng)));
    const Se3 b = Se3::exp(tangent(2 * axis(rng), 1 * axis(rng)));
    EXPECT_LT(((a * b).matrix() - a.matrix() * b.matrix()).norm(), 1e-13);
    EXPECT_LT(((a * a.inverse()).matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-13);
    const Eigen::Vector3d p(1, 2, 3);
    EXPECT_LT((a * p - (a.matrix() * p.homogeneous()).head<3>()).norm(), 1e-13);
    EXPECT_LT((Se3::from_quaternion(a.quaternion(), a.translation()).matrix() - a.matrix()).norm(), 1e-14);
    EXPECT_LT((Se3::from_matrix(a.matrix()).matrix() - a.matrix()).norm(), 1e-15);
    EXPECT_GE(a.quaternion().w(), 0);
  }
}

TEST(Se3, RetractingByNothingStaysAndRotationsStayOrthonormal) {
  EXPECT_EQ(Se3().retract(Vector6d::Zero()).matrix(), Eigen::Matrix4d(Eigen::Matrix4d::Identity()));
  Rng rng(6, "se3_test", 0);
  Se3 t;
  for (int i = 0; i < 20000; ++i) {
    t = t.retract(tangent(0.01 * axis(rng), 0.1 * axis(rng)));
  }
  EXPECT_LT((t.rotation().transpose() * t.rotation() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(Se3, PerturbationActsInTheFrameOnTheRight) {
  const Se3 t = Se3::exp((Vector6d() << 1, 2, 3, 0, 0, pi / 2).finished());
  const Se3 moved = t.retract((Vector6d() << 0.1, 0, 0, 0, 0, 0).finished());
  // The frame's x axis points along the world's y.
  EXPECT_LT((moved.translation() - t.translation() - Eigen::Vector3d(0, 0.1, 0)).norm(), 1e-15);
}

}  // namespace
}  // namespace vsgraphs
