#include "core/base/check.h"
#include "core/base/rng.h"
#include "core/solve/factors/factor_jacobian_test.h"
#include "core/solve/factors/plane_observation.h"
#include "core/solve/factors/plane_prior.h"

namespace vsgraphs {
namespace {

Eigen::Vector3d gaussian(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

Se3 some_pose(Rng& rng) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = rng.normal();
  return Se3::exp(xi);
}

Eigen::Matrix3d some_information(Rng& rng) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = rng.normal();
  return 10 * root.transpose() * root;
}

// A plane as a camera sees it; `away_m`: how far its anchor is.
AnchoredPlane seen_plane(Rng& rng, double away_m) {
  return {gaussian(rng).normalized(), away_m * gaussian(rng).normalized(), 0.05 * rng.normal()};
}

// Tilts between estimate and plane: none, through the series' range, to nearly opposite.
constexpr double tilts_rad[] = {0, 1e-9, 1e-5, 9.9e-4, 1.01e-3, 0.05, 0.5, 1.5, 2.6};

TEST(TiltBetween, HasTheAngleAndUndoesTheRetraction) {
  Rng rng(1, "plane_factors_test", 0);
  for (double tilt : tilts_rad) {
    const AnchoredPlane plane = seen_plane(rng, 2);
    const double heading = rng.uniform(0, 6.28);
    const Eigen::Vector3d delta(tilt * std::cos(heading), tilt * std::sin(heading), 0);
    const Eigen::Vector2d found = tilt_between(plane.normal, plane.retract(delta).normal, nullptr);
    EXPECT_LT((found - delta.head<2>()).norm(), 1e-14 + 1e-9 * tilt) << tilt;
  }
  Eigen::Matrix<double, 2, 3> by_to;
  EXPECT_NEAR(tilt_between({0, 1, 0}, {0, -1, 0}, &by_to).norm(), 3.14159265, 1e-6);
  EXPECT_LT(by_to.norm(), 1.1);
}

TEST(PlaneSqrtInformation, SurvivesRankDeficiency) {
  Rng rng(2, "plane_factors_test", 0);
  const Eigen::Vector3d a = gaussian(rng), b = gaussian(rng);
  for (const Eigen::Matrix3d& information :
       {Eigen::Matrix3d(1e6 * a * a.transpose()),
        Eigen::Matrix3d(1e8 * a * a.transpose() + b * b.transpose()),
        Eigen::Matrix3d(Eigen::Matrix3d::Zero()), some_information(rng)}) {
    const Eigen::Matrix3d s = plane_sqrt_information(information);
    ASSERT_TRUE(s.allFinite());
    EXPECT_LT((s.transpose() * s - information).norm(), 1e-12 * (information.norm() + 1));
  }
  const Eigen::Vector3d free = a.cross(b).normalized();
  const Eigen::Matrix3d s = plane_sqrt_information(1e6 * (a * a.transpose() + b * b.transpose()));
  EXPECT_LT((s * free).norm(), 1e-3);
}

TEST(PlaneObservation, JacobiansAgreeWithDifferences) {
  Rng rng(3, "plane_factors_test", 0);
  for (double tilt : tilts_rad) {
    for (double away_m : {0.0, 0.01, 2.0, 50.0}) {
      const Se3 pose = some_pose(rng);
      const PlaneEstimate seen{seen_plane(rng, away_m), some_information(rng)};
      StructureVariables structures;
      const Eigen::Vector3d anchor = 3 * gaussian(rng);
      const Eigen::Vector3d delta(tilt, 0, 0.1);
      structures.planes = {{}, seen.plane.retract(delta).transformed(pose).anchored_at(anchor)};
      expect_factor_jacobians(PlaneObservationFactor(1, 1, seen), {Se3(), pose}, structures,
                              tilt > 2 ? 3e-4 : 1e-3);
    }
  }
}

TEST(PlaneObservation, ResidualIsTheWhitenedDifferenceInTheCamera) {
  Rng rng(4, "plane_factors_test", 0);
  for (int i = 0; i < 20; ++i) {
    const Se3 pose = some_pose(rng);
    const PlaneEstimate seen{seen_plane(rng, 2), some_information(rng)};
    StructureVariables structures;
    structures.planes = {{gaussian(rng).normalized(), gaussian(rng), 0.3}};
    const AnchoredPlane in_camera =
        structures.planes[0].transformed(pose.inverse()).anchored_at(seen.plane.anchor);
    const Eigen::Vector3d difference = seen.plane.local(in_camera);
    const double expected = difference.dot(seen.information * difference);
    const double chi2 = residual_of(PlaneObservationFactor(0, 0, seen), {pose}, structures).squaredNorm();
    EXPECT_NEAR(chi2, expected, 1e-9 * (1 + expected));
  }
}

TEST(PlaneObservation, APatchOfARetiredKeyframePullsOnItsAnchorAllTheSame) {
  // The same sighting, told in the camera's frame and in the anchor keyframe's.
  Rng rng(5, "plane_factors_test", 0);
  const Se3 anchor = some_pose(rng), anchor_from_camera = some_pose(rng);
  SurfacePatch patch;
  patch.plane = seen_plane(rng, 2);
  patch.information = some_information(rng);
  StructureVariables structures;
  structures.planes = {
      patch.plane.retract({0.2, -0.1, 0.05}).transformed(anchor * anchor_from_camera).anchored_at({1, 2, 3})};
  const double direct = residual_of(PlaneObservationFactor(0, 0, plane_estimate(patch)),
                                    {anchor * anchor_from_camera}, structures)
                            .squaredNorm();
  const double through_anchor =
      residual_of(PlaneObservationFactor(0, 0, plane_estimate(patch, anchor_from_camera)), {anchor},
                  structures)
          .squaredNorm();
  EXPECT_GT(direct, 0.01);
  EXPECT_NEAR(direct, through_anchor, 1e-9 * direct);
}

TEST(PlaneObservation, IsRobustByItsWholeLength) {
  const PlaneEstimate seen{{-Eigen::Vector3d::UnitZ(), {0, 0, 2}, 0},
                           Eigen::Vector3d(1e4, 1e4, 1e4).asDiagonal()};
  const PlaneObservationFactor factor(0, 0, seen);
  EXPECT_EQ(factor.robust().delta, huber_3dof.delta);
  StructureVariables structures;
  structures.planes = {seen.plane.retract({0.1, 0, 0.1})};
  const double squared = residual_of(factor, {Se3()}, structures).squaredNorm();
  EXPECT_NEAR(squared, 200, 1e-6);
  EXPECT_NEAR(factor.robust().weight(squared), huber_3dof.delta / std::sqrt(200), 1e-6);
}

TEST(PlaneObservation, UnknownDirectionsPullOnNothing) {
  // Points on a line know one tilt and the offset.
  const PlaneEstimate seen{{-Eigen::Vector3d::UnitZ(), {0, 0, 2}, 0},
                           Eigen::Vector3d(1e5, 0, 1e5).asDiagonal()};
  StructureVariables structures;
  structures.planes = {seen.plane.retract({0, 0.3, 0})};
  EXPECT_LT(residual_of(PlaneObservationFactor(0, 0, seen), {Se3()}, structures).norm(), 1e-9);
  structures.planes = {seen.plane.retract({0.3, 0, 0})};
  EXPECT_GT(residual_of(PlaneObservationFactor(0, 0, seen), {Se3()}, structures).norm(), 90);
}

TEST(PlanePrior, JacobianAgreesWithDifferences) {
  Rng rng(7, "plane_factors_test", 0);
  for (double tilt : tilts_rad) {
    for (double away_m : {0.0, 2.0, 50.0}) {
      const PlaneEstimate known{seen_plane(rng, away_m), some_information(rng)};
      StructureVariables structures;
      structures.planes = {known.plane.retract({0, tilt, -0.1}).anchored_at(3 * gaussian(rng))};
      expect_factor_jacobians(PlanePrior(0, known, {1}), {}, structures, tilt > 2 ? 3e-4 : 1e-3);
    }
  }
}

TEST(PlanePrior, IsTheObservationOfACameraThatStandsStill) {
  Rng rng(8, "plane_factors_test", 0);
  const Se3 pose = some_pose(rng);
  const PlaneEstimate seen{seen_plane(rng, 2), some_information(rng)};
  StructureVariables structures;
  structures.planes = {seen.plane.retract({0.2, 0.3, 0.1}).transformed(pose).anchored_at({3, 2, 1})};
  const double observed = residual_of(PlaneObservationFactor(0, 0, seen), {pose}, structures).norm();
  EXPECT_NEAR(residual_of(PlanePrior(0, seen.transformed(pose)), {}, structures).norm(), observed,
              1e-9 * observed);
}

TEST(PlanePrior, RefusesInformationThatIsNotFinite) {
  PlaneEstimate known;
  known.information(1, 1) = std::nan("");
  EXPECT_THROW(PlanePrior(0, known), InputError);
}

}  // namespace
}  // namespace vsgraphs
