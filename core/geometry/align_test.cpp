#include "core/geometry/align.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/check.h"
#include "core/base/rng.h"

namespace vsgraphs {
namespace {

struct Pairs {
  std::vector<Eigen::Vector3d> a, b;
};

Se3 some_transform(double radians) {
  return Se3::exp((Vector6d() << 1, -2, 0.5, 0.6 * radians, -0.64 * radians, 0.48 * radians).finished());
}

Pairs pairs(const Se3& a_from_b, int count, double noise, Eigen::Vector3d spread = Eigen::Vector3d::Ones()) {
  Rng rng(1, "align_test", static_cast<std::uint64_t>(count));
  const auto draw = [&] { return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()); };
  Pairs p;
  for (int i = 0; i < count; ++i) {
    p.b.push_back(spread.cwiseProduct(draw()) + Eigen::Vector3d(5, 5, 5));
    p.a.push_back(a_from_b * p.b.back() + noise * draw());
  }
  return p;
}

double error(const Se3& a, const Se3& b) { return (a.matrix() - b.matrix()).norm(); }

TEST(AlignPoints, RecoversTheTransformUpToHalfATurn) {
  for (double radians : {0.0, 1e-6, 0.5, 2.0, 3.14159, std::numbers::pi}) {
    const Pairs p = pairs(some_transform(radians), 10, 0);
    const auto found = align_points(p.a, p.b);
    ASSERT_TRUE(found);
    EXPECT_LT(error(*found, some_transform(radians)), 1e-10);
  }
}

TEST(AlignPoints, ThreePointsAndPlanesAreEnough) {
  const Se3 truth = some_transform(1.0);
  const Pairs three = pairs(truth, 3, 0), plane = pairs(truth, 50, 0, {1, 1, 0});
  ASSERT_TRUE(align_points(three.a, three.b));
  EXPECT_LT(error(*align_points(three.a, three.b), truth), 1e-10);
  ASSERT_TRUE(align_points(plane.a, plane.b));
  EXPECT_LT(error(*align_points(plane.a, plane.b), truth), 1e-10);
}

TEST(AlignPoints, NeverReturnsAReflection) {
  // A mirrored, noisy, nearly flat set is best matched by a reflection; a rotation must come back all the same.
  Pairs p = pairs(some_transform(0.3), 20, 0.05, {1, 1, 0.05});
  for (auto& x : p.b) x.z() = -x.z();
  const auto found = align_points(p.a, p.b);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rotation().determinant(), 1, 1e-12);
}

TEST(AlignPoints, WeightsDecide) {
  const Se3 truth = some_transform(0.7);
  Pairs p = pairs(truth, 30, 0);
  std::vector<double> weights(30, 1.0);
  for (int i = 0; i < 10; ++i) {
    p.a[static_cast<std::size_t>(i)] += Eigen::Vector3d(1, 2, 3);
    weights[static_cast<std::size_t>(i)] = 0;
  }
  EXPECT_LT(error(*align_points(p.a, p.b, weights), truth), 1e-10);
  EXPECT_GT(error(*align_points(p.a, p.b), truth), 0.1);
}

TEST(AlignPoints, IsTheLeastSquaresOptimum) {
  const Pairs p = pairs(some_transform(0.7), 40, 0.1);
  const Se3 found = *align_points(p.a, p.b);
  const auto cost = [&](const Se3& t) {
    double sum = 0;
    for (std::size_t i = 0; i < p.a.size(); ++i) sum += (p.a[i] - t * p.b[i]).squaredNorm();
    return sum;
  };
  for (int k = 0; k < 6; ++k) {
    for (double step : {-1e-3, 1e-3}) EXPECT_GT(cost(found.retract(step * Vector6d::Unit(k))), cost(found));
  }
}

TEST(AlignPoints, NothingWhereARotationIsOpen) {
  const Se3 truth = some_transform(1.0);
  const Pairs line = pairs(truth, 20, 0, {1, 0, 0}), two = pairs(truth, 2, 0),
              same = pairs(truth, 9, 0, {0, 0, 0});
  EXPECT_FALSE(align_points(line.a, line.b));
  EXPECT_FALSE(align_points(two.a, two.b));
  EXPECT_FALSE(align_points(same.a, same.b));
  EXPECT_FALSE(align_points({}, {}));
  Pairs bad = pairs(truth, 5, 0);
  bad.a[2].x() = std::nan("");
  EXPECT_FALSE(align_points(bad.a, bad.b));
  EXPECT_THROW(align_points(line.a, two.b), InputError);
}

}  // namespace
}  // namespace vsgraphs
