#include "core/geometry/plane_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <limits>

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

// A point of the plane within 0.8 x 0.4 m around its anchor.
Eigen::Vector3d point_on(const AnchoredPlane& plane, Rng& rng) {
  return plane.anchor +
         tangent_basis(plane.normal) * Eigen::Vector2d(rng.uniform(-0.8, 0.8), rng.uniform(-0.4, 0.4));
}

TEST(PlaneFit, PerfectPlaneIsFoundExactlyAndIsNotSingular) {
  Rng rng(1, "plane_fit_test", 0);
  for (int i = 0; i < 20; ++i) {
    const AnchoredPlane truth = surface(rng);
    PlaneSums sums;
    for (int k = 0; k < 200; ++k) sums.add(point_on(truth, rng), rng.uniform(1e4, 1e5));
    const auto fit = sums.fit();
    ASSERT_TRUE(fit);
    const AnchoredPlane& plane = fit->estimate.plane;
    EXPECT_GT(plane.normal.dot(truth.normal), 1 - 1e-12);
    EXPECT_LT(plane.normal.dot(plane.anchor), 0) << "the normal looks at the camera";
    EXPECT_NEAR(truth.signed_distance(plane.anchor), 0, 1e-9);
    EXPECT_EQ(plane.offset_m, 0);
    EXPECT_LT(fit->rms_m, 1e-6);
    const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(fit->estimate.information).eigenvalues();
    EXPECT_GT(values[0], 1e3);
    EXPECT_LT(values[2], 1e8);
  }
}

TEST(PlaneFit, InformationPredictsTheScatterOfTheFit) {
  // 500 draws of 60 points whose sigma grows across the plane: squared errors whitened by the information have mean 3.
  Rng rng(2, "plane_fit_test", 0);
  const AnchoredPlane truth = surface(rng);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d predicted = Eigen::Matrix3d::Zero();
  double chi2 = 0;
  constexpr int draws = 500;
  for (int i = 0; i < draws; ++i) {
    PlaneSums sums;
    for (int k = 0; k < 60; ++k) {
      const Eigen::Vector3d x = point_on(truth, rng);
      const double sigma = 0.005 + 0.01 * std::abs(x.x() - truth.anchor.x());
      sums.add(x + sigma * rng.normal() * truth.normal, 1 / (sigma * sigma));
    }
    const auto fit = sums.fit(0);
    ASSERT_TRUE(fit);
    const AnchoredPlane& plane = fit->estimate.plane;
    const Eigen::Vector3d error = plane.local(truth.anchored_at(plane.anchor));
    chi2 += error.dot(fit->estimate.information * error) / draws;
    // In the truth's basis, where draws are comparable.
    const Eigen::Vector3d same = truth.local(plane.anchored_at(truth.anchor));
    covariance += same * same.transpose() / draws;
    Eigen::Matrix3d to_truth = Eigen::Matrix3d::Identity();
    to_truth.topLeftCorner<2, 2>() = tangent_basis(truth.normal).transpose() * tangent_basis(plane.normal);
    to_truth.bottomLeftCorner<1, 2>() =
        (truth.anchor - plane.anchor).transpose() * tangent_basis(plane.normal);
    predicted += to_truth * fit->estimate.information.inverse() * to_truth.transpose() / draws;
  }
  EXPECT_NEAR(chi2, 3, 0.35);  // sigma of the mean 0.11
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(covariance(i, i), predicted(i, i), 0.25 * predicted(i, i)) << i;
}

TEST(PlaneFit, InformationStopsGrowingAtTheEffectiveCount) {
  Rng rng(3, "plane_fit_test", 0);
  const AnchoredPlane truth = surface(rng);
  const auto offset_information = [&](int n) {
    PlaneSums sums;
    for (int k = 0; k < n; ++k) sums.add(point_on(truth, rng), 1e4);
    return sums.fit(30)->estimate.information(2, 2);
  };
  EXPECT_NEAR(offset_information(10), 10e4, 1);
  EXPECT_NEAR(offset_information(30), 30e4, 1);
  EXPECT_NEAR(offset_information(5000), 30e4, 1);
}

TEST(PlaneFit, PiecesMergeToTheWhole) {
  Rng rng(4, "plane_fit_test", 0);
  const AnchoredPlane truth = surface(rng);
  PlaneSums whole, pieces[3], merged;
  for (int k = 0; k < 300; ++k) {
    const Eigen::Vector3d x = point_on(truth, rng) + 0.01 * rng.normal() * truth.normal;
    whole.add(x, 1 + k);
    pieces[k % 3].add(x, 1 + k);
  }
  for (const PlaneSums& piece : pieces) merged += piece;
  const auto a = whole.fit(), b = merged.fit();
  ASSERT_TRUE(a && b);
  EXPECT_EQ(merged.count(), 300);
  EXPECT_LT(a->estimate.plane.local(b->estimate.plane.anchored_at(a->estimate.plane.anchor)).norm(), 1e-9);
  EXPECT_TRUE(a->estimate.information.isApprox(b->estimate.information, 1e-9));
  EXPECT_NEAR(a->rms_m, whole.rms_m(a->estimate.plane), 1e-9);
  EXPECT_NEAR(a->rms_m, 0.01, 0.002);
  AnchoredPlane shifted = a->estimate.plane;
  shifted.offset_m += 0.3;
  EXPECT_NEAR(whole.rms_m(shifted), std::hypot(0.3, a->rms_m), 1e-9);
}

TEST(PlaneFit, RefusesWhatIsNoPlane) {
  PlaneSums two;
  two.add({0, 0, 1}, 1);
  two.add({1, 0, 1}, 1);
  EXPECT_FALSE(two.fit());
  PlaneSums line;
  for (int i = 0; i < 50; ++i) line.add({0.1 * i, 0.3 + 0.07 * i, 2 - 0.01 * i}, 3);
  EXPECT_FALSE(line.fit());
  PlaneSums weightless;
  for (int i = 0; i < 5; ++i) weightless.add({i % 2 * 1.0, i / 2 * 1.0, 1}, 0);
  EXPECT_FALSE(weightless.fit());
  PlaneSums broken;
  for (int i = 0; i < 5; ++i)
    broken.add({i % 2 * 1.0, i == 3 ? std::numeric_limits<double>::quiet_NaN() : i / 2 * 1.0, 1}, 1);
  EXPECT_FALSE(broken.fit());
}

TEST(NormalSigma, IsDepthNoiseHeadOnAndNeverZeroAtGrazingAngles) {
  const Camera camera;
  SurfaceNoise noise;
  noise.model_m = 0;
  const Eigen::Vector3d ahead(0, 0, 3);
  EXPECT_NEAR(normal_sigma_m(camera, noise, ahead, {0, 0, -1}), camera.depth_noise.sigma_m(3), 1e-12);
  // A surface that contains the ray: depth errors slide along it, only the pixel matters.
  EXPECT_NEAR(normal_sigma_m(camera, noise, ahead, {1, 0, 0}), 0.5 * 3 / camera.fx, 1e-12);
  EXPECT_GT(normal_sigma_m(camera, {0, 0.002}, ahead, {1, 0, 0}), 0.0019);
  EXPECT_GT(normal_sigma_m(camera, {}, ahead, {0, 0, -1}), normal_sigma_m(camera, noise, ahead, {0, 0, -1}));
}

TEST(NormalSigma, MatchesDisturbedReadings) {
  Rng rng(5, "plane_fit_test", 0);
  const Camera camera;
  const SurfaceNoise noise{0.5, 0.002};
  for (int i = 0; i < 10; ++i) {
    const AnchoredPlane plane = surface(rng);
    const Eigen::Vector2d px = camera.project(plane.anchor);
    double sum = 0;
    constexpr int draws = 4000;
    for (int k = 0; k < draws; ++k) {
      const double z = plane.anchor.z() + camera.depth_noise.sigma_m(plane.anchor.z()) * rng.normal();
      const Eigen::Vector3d read =
          camera.unproject(px.x() + 0.5 * rng.normal(), px.y() + 0.5 * rng.normal(), z);
      const double distance = plane.signed_distance(read) + noise.model_m * rng.normal();
      sum += distance * distance / draws;
    }
    const double sigma = normal_sigma_m(camera, noise, plane.anchor, plane.normal);
    EXPECT_NEAR(std::sqrt(sum), sigma, 0.06 * sigma);
  }
}

}  // namespace
}  // namespace vsgraphs
