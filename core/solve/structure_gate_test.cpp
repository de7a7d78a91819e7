#include "core/solve/structure_gate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "core/base/rng.h"
#include "core/solve/bundle_adjustment.h"
#include "core/solve/factors/plane_observation.h"
#include "core/solve/factors/plane_parallel.h"
#include "core/solve/factors/plane_perpendicular.h"
#include "core/solve/factors/relative_pose.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

constexpr double deg = std::numbers::pi / 180;

TEST(AngleGate, EntersBelowSixAndLeavesAboveTenDegrees) {
  const AngleGate gate;
  bool held = false;
  const std::array<std::pair<double, bool>, 7> course{
      {{9, false}, {6.1, false}, {5.9, true}, {9.9, true}, {10.1, false}, {8, false}, {0, true}}};
  for (const auto& [deviation, expected] : course) {
    held = gate.holds(held, deviation * deg);
    EXPECT_EQ(held, expected) << deviation;
  }
}

TEST(AngleGate, DeviationsAreExactAtTheirZeroAndBlindToFacing) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  for (double angle : {0.0, 1e-9, 5 * deg, 80 * deg, 90 * deg, 100 * deg, 175 * deg, 180 * deg}) {
    const Eigen::Vector3d n(std::cos(angle), std::sin(angle), 0);
    EXPECT_NEAR(deviation_from_parallel_rad(x, n), std::min(angle, std::numbers::pi - angle), 1e-15);
    EXPECT_NEAR(deviation_from_perpendicular_rad(x, n), std::abs(angle - 90 * deg), 1e-15);
  }
}

// A room with a front, a back wall parallel to it, two sides that lean to `corner_rad` against the front, and a ground;
// seen from ten poses in it, through noise.
class Room {
 public:
  explicit Room(double corner_rad) {
    const double lean = std::numbers::pi / 2 - corner_rad;  // of the sides, towards each other at the back
    const double s = std::sin(lean), c = std::cos(lean);
    truth_ = {{{0, 0, 1}, {0, 0, -2}, 0},
              {{0, 0, -1}, {0, 0, 2}, 0},
              {{c, 0, -s}, {-2, 0, 0}, 0},
              {{-c, 0, -s}, {2, 0, 0}, 0},
              {{0, -1, 0}, {0, 1.2, 0}, 0}};
  }

  // The turn about the vertical from wall b to wall a as estimated, minus the true one, rad. With its sign: an angle in
  // [0, pi] between walls that face each other could only err to one side.
  double error(const BundleProblem& problem, int a, int b) const {
    const auto heading = [](const AnchoredPlane& p) { return std::atan2(p.normal.x(), p.normal.z()); };
    const auto turn = [&](const std::vector<AnchoredPlane>& p) {
      return heading(p[static_cast<std::size_t>(a)]) - heading(p[static_cast<std::size_t>(b)]);
    };
    return std::remainder(turn(problem.structures.planes) - turn(truth_), 2 * std::numbers::pi);
  }

  BundleProblem observed(Rng& rng) const {
    BundleProblem problem;
    const Eigen::Matrix3d information = Eigen::Vector3d(50 * 50, 50 * 50, 100 * 100).asDiagonal();
    std::vector<Se3> poses;
    for (int i = 0; i < 10; ++i) {
      Vector6d turn = Vector6d::Zero();
      turn << 0.5 * rng.normal(), 0, 0.5 * rng.normal(), 0, 36 * deg * i, 0;
      poses.push_back(Se3::exp(turn));
      problem.poses.push_back(i == 0 ? poses[0] : poses.back().retract(random_tangent(rng, 0.02, 0.01)));
      problem.pose_fixed.push_back(i == 0);
      if (i == 0) continue;
      const Se3 moved =
          poses[poses.size() - 2].inverse() * poses.back() * Se3::exp(random_tangent(rng, 0.01, 0.5 * deg));
      Vector6d weights;
      weights << Eigen::Vector3d::Constant(100), Eigen::Vector3d::Constant(1 / (0.5 * deg));
      problem.factors.push_back(std::make_unique<RelativePose>(VariableRef{VariableKind::pose, i - 1},
                                                               VariableRef{VariableKind::pose, i}, moved,
                                                               weights.asDiagonal()));
    }
    for (std::size_t p = 0; p < truth_.size(); ++p) {
      problem.structures.planes.push_back(
          truth_[p].retract(0.03 * Eigen::Vector3d(rng.normal(), rng.normal(), 1)));
      for (std::size_t i = 0; i < poses.size(); ++i) {
        // In view: the camera looks at it, or at the ground ahead.
        const AnchoredPlane in_camera = truth_[p].transformed(poses[i].inverse());
        if (p < 4 && in_camera.normal.z() > -0.4) continue;
        const Eigen::Vector3d patch = in_camera.project({0, 0, 1.5});
        const Eigen::Vector3d noise(0.02 * rng.normal(), 0.02 * rng.normal(), 0.01 * rng.normal());
        problem.factors.push_back(std::make_unique<PlaneObservationFactor>(
            static_cast<int>(i), static_cast<int>(p),
            PlaneEstimate{in_camera.anchored_at(patch).retract(noise), information}));
      }
    }
    return problem;
  }

 private:
  std::vector<AnchoredPlane> truth_;
};

// Holds the pairs the gate lets through, judged by the planes as they are; returns how many pairs of walls.
int hold_pairs(BundleProblem& problem, const AngleGate& gate) {
  std::vector<std::pair<int, int>> parallel, perpendicular;
  const auto& planes = problem.structures.planes;
  for (int a = 0; a < 4; ++a) {
    const Eigen::Vector3d& n = planes[static_cast<std::size_t>(a)].normal;
    for (int b = a + 1; b < 4; ++b) {
      const Eigen::Vector3d& m = planes[static_cast<std::size_t>(b)].normal;
      const double from_parallel = deviation_from_parallel_rad(n, m);
      const double from_perpendicular = deviation_from_perpendicular_rad(n, m);
      if (from_parallel < from_perpendicular && gate.holds(false, from_parallel)) parallel.emplace_back(a, b);
      if (from_parallel >= from_perpendicular && gate.holds(false, from_perpendicular))
        perpendicular.emplace_back(a, b);
    }
    if (gate.holds(false, deviation_from_perpendicular_rad(n, planes[4].normal)))
      problem.factors.push_back(std::make_unique<PlanePerpendicular>(a, 4));
  }
  for (const auto& [a, b] : parallel)
    problem.factors.push_back(
        std::make_unique<PlaneParallel>(a, b, PlaneAngle{2 * deg, static_cast<int>(parallel.size())}));
  for (const auto& [a, b] : perpendicular)
    problem.factors.push_back(std::make_unique<PlanePerpendicular>(
        a, b, PlaneAngle{2 * deg, static_cast<int>(perpendicular.size())}));
  return static_cast<int>(parallel.size() + perpendicular.size());
}

struct Bend {
  double worst_bias_rad = 0;  // of the mean over the draws, over all pairs of walls
  double rms_rad = 0;         // of single draws
  double pairs = 0;           // held, on average
};

Bend bend_of(double corner_rad, const AngleGate& gate) {
  Rng rng(1, "structure_gate_test", 0);
  const Room room(corner_rad);
  constexpr int draws = 100;
  std::array<double, 6> bias{};
  Bend bend;
  BundleOptions options;
  options.max_iterations = 20;
  for (int draw = 0; draw < draws; ++draw) {
    BundleProblem problem = room.observed(rng);
    solve_bundle(problem, options);
    bend.pairs += static_cast<double>(hold_pairs(problem, gate)) / draws;
    solve_bundle(problem, options);
    std::size_t pair = 0;
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        const double error = room.error(problem, a, b);
        bias[pair++] += error / draws;
        bend.rms_rad += error * error / (6 * draws);
      }
    }
  }
  for (double b : bias) bend.worst_bias_rad = std::max(bend.worst_bias_rad, std::abs(b));
  bend.rms_rad = std::sqrt(bend.rms_rad);
  return bend;
}

const AngleGate holds_all{2, 2};  // rad
const AngleGate holds_none{-1, -1};

TEST(StructureGate, ATrapezoidRoomIsNotBentSquare) {
  const Bend gated = bend_of(80 * deg, {});
  EXPECT_LT(gated.worst_bias_rad, 0.5 * deg);
  EXPECT_NEAR(gated.pairs, 1, 0.05);  // front and back
  // Without the gate it would be.
  EXPECT_GT(bend_of(80 * deg, holds_all).worst_bias_rad, 1 * deg);
}

TEST(StructureGate, ARoomJustInsideTheGateIsHardlyBent) {
  for (double corner : {84.5, 86.0, 95.5})
    EXPECT_LT(bend_of(corner * deg, {}).worst_bias_rad, 0.5 * deg) << corner;
}

TEST(StructureGate, ASquareRoomGainsFromIt) {
  const Bend held = bend_of(90 * deg, {}), open = bend_of(90 * deg, holds_none);
  EXPECT_NEAR(held.pairs, 6, 0.05);
  EXPECT_EQ(open.pairs, 0);
  EXPECT_LT(held.rms_rad, 0.95 * open.rms_rad);
}

}  // namespace
}  // namespace vsgraphs
