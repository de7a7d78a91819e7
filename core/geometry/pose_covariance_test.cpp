#include "core/geometry/pose_covariance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/check.h"
#include "core/base/rng.h"

namespace vsgraphs {
namespace {

const Se3 a_from_b(so3_exp({0.3, -0.4, 0.8}), {1, 2, -0.5});
const Se3 b_from_c(so3_exp({-0.7, 0.1, 0.2}), {-0.4, 0.3, 2});

Vector6d draw(Rng& rng, const Vector6d& sigmas) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = sigmas[i] * rng.normal();
  return xi;
}

const Vector6d sigmas_b = (Vector6d() << 0.01, 0.02, 0.005, 0.004, 0.01, 0.002).finished();
const Vector6d sigmas_c = (Vector6d() << 0.002, 0.01, 0.01, 0.01, 0.003, 0.006).finished();
Matrix6d squared(const Vector6d& sigmas) { return sigmas.cwiseAbs2().asDiagonal(); }

// What the formula says against what many draws give.
template <typename Sample>
Matrix6d sampled(Sample&& sample) {
  Rng rng(1, "pose_covariance", 0);
  Matrix6d sum = Matrix6d::Zero();
  constexpr int draws = 40000;
  for (int i = 0; i < draws; ++i) {
    const Vector6d error = sample(rng);
    sum += error * error.transpose();
  }
  return sum / draws;
}

TEST(PoseCovariance, CompositionMatchesSampling) {
  const Matrix6d expected = sampled([](Rng& rng) {
    const Se3 noisy = a_from_b.retract(draw(rng, sigmas_b)) * b_from_c.retract(draw(rng, sigmas_c));
    return ((a_from_b * b_from_c).inverse() * noisy).log();
  });
  const Matrix6d formula = compose_covariance(squared(sigmas_b), b_from_c, squared(sigmas_c));
  EXPECT_LT((formula - expected).norm(), 0.05 * expected.norm());
}

TEST(PoseCovariance, InversionMatchesSampling) {
  const Matrix6d expected =
      sampled([](Rng& rng) { return (a_from_b * a_from_b.retract(draw(rng, sigmas_b)).inverse()).log(); });
  const Matrix6d formula = inverted_covariance(a_from_b, squared(sigmas_b));
  EXPECT_LT((formula - expected).norm(), 0.05 * expected.norm());
}

TEST(PoseCovariance, InformationAndCovarianceAreInverse) {
  const Matrix6d c = compose_covariance(squared(sigmas_b), b_from_c, squared(sigmas_c));
  EXPECT_LT((information_of(c) * c - Matrix6d::Identity()).norm(), 1e-9);
  EXPECT_LT((covariance_of(information_of(c)) - c).norm(), 1e-6 * c.norm());
  EXPECT_GT(covariance_of(Matrix6d::Zero())(0, 0), 1e5);
  EXPECT_THROW(information_of(-Matrix6d::Identity()), InvariantError);
}

TEST(PoseCovariance, SigmasCountStandardDeviations) {
  Vector6d error = Vector6d::Zero();
  error[1] = 0.06;
  EXPECT_NEAR(sigmas_of(error, squared(sigmas_b)), 3.0, 1e-12);
}

TEST(PoseCovariance, AFloorRaisesWhatIsBelowItAndLeavesTheRest) {
  const Matrix6d floor = isotropic_covariance(0.01, 0.02);
  Rng rng(4, "pose_covariance_test", 0);
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = 0.02 * rng.normal();
  const Matrix6d covariance = root * root.transpose();
  const Matrix6d raised = floored(covariance, floor);
  for (int i = 0; i < 200; ++i) {
    const Vector6d way = draw(rng, Vector6d::Ones());
    EXPECT_GE(way.dot(raised * way), 0.999999 * way.dot(covariance * way));
    EXPECT_GE(way.dot(raised * way), 0.999999 * way.dot(floor * way));
  }
  EXPECT_TRUE(floored(Matrix6d::Zero(), floor).isApprox(floor, 1e-12));
  EXPECT_TRUE(floored(4 * floor + covariance, floor).isApprox(4 * floor + covariance, 1e-9));
}

TEST(PoseCovariance, NotEveryMatrixIsOne) {
  const Matrix6d good =
      compose_covariance(isotropic_covariance(0.1, 0.2), b_from_c, isotropic_covariance(3, 1));
  EXPECT_TRUE(is_covariance(good));
  EXPECT_TRUE(is_covariance(Matrix6d::Zero()));
  Matrix6d bad = good;
  bad(1, 4) += 1e-3;
  EXPECT_FALSE(is_covariance(bad)) << "not symmetric";
  EXPECT_FALSE(is_covariance(good - 2 * isotropic_covariance(3, 1))) << "negative";
  EXPECT_FALSE(is_covariance(1e7 * Matrix6d::Identity()));
  bad(0, 0) = std::nan("");
  EXPECT_FALSE(is_covariance(bad));
}

}  // namespace
}  // namespace vsgraphs
