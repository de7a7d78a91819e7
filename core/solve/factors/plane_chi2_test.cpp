// The plane observation from depth readings to chi^2: fit, condensation and factor together.
#include <Eigen/Eigenvalues>

#include "core/base/rng.h"
#include "core/geometry/plane_fit.h"
#include "core/solve/factors/factor_jacobian_test.h"
#include "core/solve/factors/plane_observation.h"

namespace vsgraphs {
namespace {

Se3 some_pose(Rng& rng) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = rng.normal();
  return Se3::exp(xi);
}

// A camera's readings of a wall: `count` rays, in 30 cells whose readings share part of their noise, or each its own.
class WallReadings {
 public:
  WallReadings(int count, double shared_share, Rng& rng) : count_(count), shared_(shared_share), rng_(rng) {}

  PlaneSums draw(const AnchoredPlane& wall) {
    double cells[30];
    for (double& cell : cells) cell = rng_.normal();
    PlaneSums sums;
    for (int i = 0; i < count_; ++i) {
      const int cell = i % 30;
      const double u = 80 * (cell % 6 + rng_.uniform()) + 60, v = 80 * (cell / 6 + rng_.uniform()) + 40;
      const Eigen::Vector3d ray = camera_.unproject(u, v, 1);
      const Eigen::Vector3d x = -wall.signed_distance({0, 0, 0}) / wall.normal.dot(ray) * ray;
      const double sigma = normal_sigma_m(camera_, noise_, x, wall.normal);
      const double noise = std::sqrt(shared_) * cells[cell] + std::sqrt(1 - shared_) * rng_.normal();
      sums.add(x + sigma * noise * wall.normal, 1 / (sigma * sigma));
    }
    return sums;
  }

 private:
  Camera camera_;
  SurfaceNoise noise_;
  int count_;
  double shared_;
  Rng& rng_;
};

double mean_chi2_at_truth(int count, double shared, double effective_count, Rng& rng) {
  WallReadings readings(count, shared, rng);
  double sum = 0;
  constexpr int draws = 400;
  for (int i = 0; i < draws; ++i) {
    const Se3 pose = some_pose(rng);
    const AnchoredPlane wall{
        Eigen::Vector3d(0.5 * rng.uniform(-1, 1), 0.5 * rng.uniform(-1, 1), -1).normalized(), {0, 0, 2.5}, 0};
    const auto fit = readings.draw(wall).fit(effective_count);
    EXPECT_TRUE(fit);
    StructureVariables structures;
    structures.planes = {wall.transformed(pose).anchored_at({4, 5, 6})};
    sum += residual_of(PlaneObservationFactor(0, 0, fit->estimate), {pose}, structures).squaredNorm();
  }
  return sum / draws;
}

TEST(PlaneObservation, Chi2IsThreeAtTheTruthWhateverTheNumberOfReadings) {
  // Sigma of each mean: sqrt(6 / 400) = 0.12.
  Rng rng(6, "plane_chi2_test", 0);
  for (int count : {30, 250, 3000}) {
    EXPECT_NEAR(mean_chi2_at_truth(count, 0, 0, rng), 3, 0.5) << count << " independent readings";
    EXPECT_NEAR(mean_chi2_at_truth(count, 1, 30, rng), 3, 0.5) << count << " readings worth 30";
  }
}

TEST(PlaneObservation, APerfectPlaneIsNotSingular) {
  PlaneSums sums;
  for (int i = 0; i < 100; ++i) sums.add({0.1 * (i % 10), 0.1 * (i / 10), 2}, 1 / (0.01 * 0.01));
  const auto fit = sums.fit();
  ASSERT_TRUE(fit);
  const PlaneObservationFactor factor(0, 0, fit->estimate);
  StructureVariables structures;
  structures.planes = {{-Eigen::Vector3d::UnitZ(), {0, 0, 2}, 0}};
  const std::vector<Se3> poses{Se3()};
  FactorRows rows;
  factor.resize(rows);
  ASSERT_TRUE(factor.evaluate({poses, structures}, true, rows));
  EXPECT_LT(rows.residual.norm(), 1e-6);
  const Eigen::Matrix3d hessian = rows.jacobians[1].transpose() * rows.jacobians[1];
  const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(hessian).eigenvalues();
  EXPECT_GT(values[0], 100);
  EXPECT_LT(values[2], 1e7);
}

}  // namespace
}  // namespace vsgraphs
