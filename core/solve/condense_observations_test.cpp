#include "core/solve/condense_observations.h"

#include <gtest/gtest.h>

#include <memory>

#include "core/base/rng.h"
#include "core/solve/bundle_adjustment.h"
#include "core/solve/factors/factor_jacobian_test.h"
#include "core/solve/factors/plane_prior.h"

namespace vsgraphs {
namespace {

Eigen::Vector3d gaussian(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

const AnchoredPlane ground{Eigen::Vector3d(0.1, -1, 0.05).normalized(), {2, 1.2, 5}, 0};

// Patches all over the ground, tilts known to about 0.01, offsets to 5 mm; what they say has that noise.
std::vector<WeightedPlane> patches(int count, Rng& rng) {
  std::vector<WeightedPlane> seen;
  for (int i = 0; i < count; ++i) {
    Eigen::Matrix3d root = Eigen::Vector3d(100, 80, 200).asDiagonal();
    for (int k = 0; k < 9; ++k) root(k / 3, k % 3) += 15 * rng.normal();
    const Eigen::Matrix3d information = root.transpose() * root;
    const Eigen::Vector3d at = ground.project(ground.anchor + 3 * gaussian(rng));
    const Eigen::Vector3d noise = root.inverse() * gaussian(rng);
    seen.push_back({{ground.anchored_at(at).retract(noise), information}, rng.uniform(0.3, 1)});
  }
  return seen;
}

double cost_of(const std::vector<WeightedPlane>& seen, const AnchoredPlane& plane, const Huber& robust) {
  double sum = 0;
  for (const WeightedPlane& o : seen) {
    const Eigen::Vector3d difference = o.seen.plane.local(plane.anchored_at(o.seen.plane.anchor));
    sum += o.weight * robust.cost(difference.dot(o.seen.information * difference));
  }
  return sum;
}

TEST(CondenseObservations, IsTheSumNearItsOptimum) {
  Rng rng(1, "condense_observations_test", 0);
  for (int count : {1, 2, 40}) {
    const std::vector<WeightedPlane> seen = patches(count, rng);
    const AnchoredPlane start = ground.retract({0.1, -0.1, 0.2});
    const auto condensed = condense_observations(seen, start, {});
    ASSERT_TRUE(condensed);
    EXPECT_EQ(condensed->plane.anchor, start.anchor);
    const double least = cost_of(seen, condensed->plane, {});
    for (int i = 0; i < 20; ++i) {
      // Steps of about a sigma of the sum.
      const Eigen::Vector3d delta =
          gaussian(rng).cwiseQuotient(condensed->information.diagonal().cwiseSqrt());
      const double rise = cost_of(seen, condensed->plane.retract(delta), {}) - least;
      const double predicted = delta.dot(condensed->information * delta);
      EXPECT_NEAR(rise, predicted, 0.02 * predicted) << count << " patches";
      EXPECT_GT(rise, 0);
    }
  }
}

TEST(CondenseObservations, OneFactorDoesWhatAllOfThemDo) {
  // The ground and an opinion against it: priors one by one, or condensed.
  Rng rng(2, "condense_observations_test", 0);
  std::vector<WeightedPlane> seen = patches(25, rng);
  for (WeightedPlane& o : seen) o.weight = 1;
  const PlaneEstimate opinion{ground.retract({0.02, 0.01, 0.05}),
                              Eigen::Vector3d(1e5, 2e5, 3e5).asDiagonal()};
  const auto solve = [&](std::vector<std::unique_ptr<const DenseFactor>> factors) {
    BundleProblem problem;
    problem.structures.planes = {ground};
    problem.factors = std::move(factors);
    problem.factors.push_back(std::make_unique<PlanePrior>(0, opinion));
    BundleOptions options;
    options.max_iterations = 30;
    options.relative_tolerance = 1e-14;
    solve_bundle(problem, options);
    return problem.structures.planes[0];
  };
  std::vector<std::unique_ptr<const DenseFactor>> all, one;
  for (const WeightedPlane& o : seen) all.push_back(std::make_unique<PlanePrior>(0, o.seen));
  one.push_back(std::make_unique<PlanePrior>(0, *condense_observations(seen, ground, {})));
  const AnchoredPlane by_all = solve(std::move(all)), by_one = solve(std::move(one));
  const double moved = ground.local(by_all).norm();
  EXPECT_GT(moved, 1e-3);
  EXPECT_LT(by_all.local(by_one).norm(), 0.01 * moved);
}

TEST(CondenseObservations, RobustWeightsHoldAgainstWrongOnes) {
  Rng rng(3, "condense_observations_test", 0);
  std::vector<WeightedPlane> seen = patches(30, rng);
  for (int i = 0; i < 5; ++i) {
    AnchoredPlane& plane = seen[static_cast<std::size_t>(6 * i)].seen.plane;
    plane = plane.retract({0.3, 0.2, 0.4});
  }
  const auto robust = condense_observations(seen, ground), plain = condense_observations(seen, ground, {});
  ASSERT_TRUE(robust && plain);
  EXPECT_LT(ground.local(robust->plane).norm(), 0.015);
  EXPECT_GT(ground.local(plain->plane).norm(), 0.04);
  // At the optimum of the robust sum, not just of some reweighted one.
  const double least = cost_of(seen, robust->plane, huber_3dof);
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d delta = (i < 3 ? 1e-3 : -1e-3) * Eigen::Vector3d::Unit(i % 3);
    EXPECT_GT(cost_of(seen, robust->plane.retract(delta), huber_3dof), least);
  }
}

TEST(CondenseObservations, PatchesThatKnowALineEachAddUp) {
  // Each fixes the tilt about one axis only; one of them alone leaves the other as it was.
  const Eigen::Vector3d anchor = ground.anchor;
  const WeightedPlane first{{ground, Eigen::Vector3d(1e4, 0, 1e4).asDiagonal()}, 1};
  const WeightedPlane second{{ground, Eigen::Vector3d(0, 1e4, 1e4).asDiagonal()}, 1};
  const AnchoredPlane start = ground.retract({0.1, 0.05, 0.1});
  const WeightedPlane both[] = {first, second};
  const auto whole = condense_observations(both, start);
  ASSERT_TRUE(whole);
  EXPECT_LT(ground.local(whole->plane).norm(), 1e-9);
  const auto half = condense_observations({&first, 1}, start);
  ASSERT_TRUE(half);
  EXPECT_TRUE(half->plane.anchor == anchor && half->information.allFinite());
  EXPECT_NEAR(ground.local(half->plane)[0], 0, 1e-6);
  EXPECT_GT(std::abs(ground.local(half->plane)[1]), 0.04);
}

TEST(CondenseObservations, NothingKnownIsNothing) {
  EXPECT_FALSE(condense_observations({}, ground));
  const WeightedPlane blind[] = {{{ground, Eigen::Matrix3d::Zero()}, 1},
                                 {{ground, Eigen::Matrix3d::Identity()}, 0}};
  EXPECT_FALSE(condense_observations(blind, ground));
}

}  // namespace
}  // namespace vsgraphs
