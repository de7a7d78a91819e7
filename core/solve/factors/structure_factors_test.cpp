// The relations among planes, rooms and floors.
#include "core/base/rng.h"
#include "core/solve/factors/factor_jacobian_test.h"
#include "core/solve/factors/floor_centroid.h"
#include "core/solve/factors/plane_parallel.h"
#include "core/solve/factors/plane_perpendicular.h"
#include "core/solve/factors/room_centroid.h"

namespace vsgraphs {
namespace {

constexpr double deg = std::numbers::pi / 180;

Eigen::Vector3d gaussian(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

// Plane 1 at the given angle to plane 0, in any direction; far away from each other's anchors.
StructureVariables two_planes(Rng& rng, double angle_rad) {
  StructureVariables structures;
  const AnchoredPlane a{gaussian(rng).normalized(), 10 * gaussian(rng), 0.1};
  const double heading = rng.uniform(0, 6.28);
  AnchoredPlane b = a.retract({angle_rad * std::cos(heading), angle_rad * std::sin(heading), 3});
  b.anchor += 5 * gaussian(rng);
  structures.planes = {a, b};
  return structures;
}

TEST(PlaneParallel, JacobiansAgreeWithDifferences) {
  Rng rng(1, "structure_factors_test", 0);
  for (double angle : {0.0, 1e-9, 1e-4, 5 * deg, 40 * deg, 90 * deg, 175 * deg, 180 * deg}) {
    const StructureVariables structures = two_planes(rng, angle);
    expect_factor_jacobians(PlaneParallel(0, 1), {}, structures);
    expect_factor_jacobians(PlaneParallel(1, 0, {1 * deg, 3}, {1}), {}, structures);
  }
}

TEST(PlaneParallel, IsTheSineOfTheAngleWhicheverWayThePlanesFace) {
  Rng rng(2, "structure_factors_test", 0);
  for (double angle : {0.0, 2 * deg, 5 * deg, 175 * deg, 180 * deg}) {
    const StructureVariables structures = two_planes(rng, angle);
    const double expected = std::sin(angle) / (2 * deg);
    EXPECT_NEAR(residual_of(PlaneParallel(0, 1), {}, structures).norm(), expected, 1e-9);
    // As long as the part of one normal in the other's tangent plane.
    const double by_basis =
        (tangent_basis(structures.planes[0].normal).transpose() * structures.planes[1].normal).norm();
    EXPECT_NEAR(by_basis / (2 * deg), expected, 1e-9);
  }
}

TEST(PlaneParallel, PullsAtFiveDegreesLikeThePerpendicularTerm) {
  Rng rng(3, "structure_factors_test", 0);
  const double parallel = residual_of(PlaneParallel(0, 1), {}, two_planes(rng, 5 * deg)).squaredNorm();
  const double perpendicular =
      residual_of(PlanePerpendicular(0, 1), {}, two_planes(rng, 85 * deg)).squaredNorm();
  EXPECT_NEAR(parallel, 6.2, 0.1);
  EXPECT_NEAR(parallel, perpendicular, 1e-6);
}

TEST(PlanePerpendicular, JacobiansAgreeWithDifferences) {
  Rng rng(4, "structure_factors_test", 0);
  for (double angle : {0.0, 1e-6, 40 * deg, 89.9999 * deg, 90 * deg, 95 * deg, 180 * deg}) {
    const StructureVariables structures = two_planes(rng, angle);
    expect_factor_jacobians(PlanePerpendicular(0, 1), {}, structures);
    expect_factor_jacobians(PlanePerpendicular(1, 0, {1 * deg, 4}, {1}), {}, structures);
  }
}

TEST(PlaneAngle, PairsOfARoomShareTheWeightOfOne) {
  Rng rng(5, "structure_factors_test", 0);
  const StructureVariables structures = two_planes(rng, 4 * deg);
  const double one = residual_of(PlaneParallel(0, 1, {2 * deg, 1}), {}, structures).squaredNorm();
  const double of_four = residual_of(PlaneParallel(0, 1, {2 * deg, 4}), {}, structures).squaredNorm();
  EXPECT_NEAR(4 * of_four, one, 1e-9);
  EXPECT_THROW(PlaneParallel(0, 1, {0, 1}), InputError);
  EXPECT_THROW(PlanePerpendicular(0, 1, {0.1, 0}), InputError);
}

TEST(RoomCentroid, JacobiansAgreeWithDifferences) {
  Rng rng(6, "structure_factors_test", 0);
  for (double away_m : {0.0, 1e-6, 3.0, 100.0}) {
    for (std::size_t count : {1u, 2u, 4u, 9u}) {
      StructureVariables structures;
      structures.centroids = {Eigen::Vector3d::Zero(), away_m * gaussian(rng)};
      std::vector<WallOfRoom> walls;
      for (std::size_t i = 0; i < count; ++i) {
        structures.planes.push_back({gaussian(rng).normalized(), away_m * gaussian(rng), rng.normal()});
        walls.push_back({static_cast<int>(i), away_m * gaussian(rng)});
      }
      expect_factor_jacobians(RoomCentroid(1, walls, 0.1), {}, structures);
    }
  }
}

TEST(RoomCentroid, OfARoomFarFromTheOriginLiesInsideIt) {
  // x 10 to 14, z 20 to 24; of every wall the middle was seen, of one a piece off the plane it has by now.
  StructureVariables structures;
  structures.centroids = {{12, 1, 22}};
  structures.planes = {{{1, 0, 0}, {10, 1, 22}, 0},
                       {{-1, 0, 0}, {14, 1, 22}, 0},
                       {{0, 0, 1}, {12, 1, 20}, 0},
                       {{0, 0, -1}, {12, 1, 24}, 0}};
  const WallOfRoom walls[] = {{0, {10.3, 1, 22}}, {1, {14, 1, 22}}, {2, {12, 1, 20}}, {3, {12, 1, 24}}};
  EXPECT_LT(residual_of(RoomCentroid(0, walls), {}, structures).norm(), 1e-9);
}

TEST(RoomCentroid, RefusesARoomWithoutWalls) {
  EXPECT_THROW(RoomCentroid(0, std::span<const WallOfRoom>{}), InputError);
  const WallOfRoom walls[] = {{0, {0, 0, 0}}};
  EXPECT_THROW(RoomCentroid(0, walls, 0), InputError);
}

TEST(FloorCentroid, JacobiansAgreeWithDifferencesAndMeanIsItsZero) {
  Rng rng(7, "structure_factors_test", 0);
  for (double away_m : {0.0, 1e-6, 3.0, 1000.0}) {
    StructureVariables structures;
    for (int i = 0; i < 5; ++i) structures.centroids.push_back(away_m * gaussian(rng));
    const int rooms[] = {4, 0, 2};
    const FloorCentroid factor(3, rooms, 0.2);
    expect_factor_jacobians(factor, {}, structures);
    structures.centroids[3] =
        (structures.centroids[4] + structures.centroids[0] + structures.centroids[2]) / 3;
    EXPECT_LT(residual_of(factor, {}, structures).norm(), 1e-9);
  }
  EXPECT_THROW(FloorCentroid(0, std::span<const int>{}), InputError);
}

}  // namespace
}  // namespace vsgraphs
