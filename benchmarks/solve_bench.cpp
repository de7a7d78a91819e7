// Cost of the solvers at the sizes the system runs them at: one tracked frame, one local window.
#include <benchmark/benchmark.h>

#include "core/solve/align_matches.h"
#include "core/solve/bundle_adjustment.h"
#include "core/solve/factors/plane_observation.h"
#include "core/solve/pose_solver.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

// Local window: 20 free and 10 fixed keyframes, 3,000 landmarks, 15,000 observations, 5 iterations, problem set-up and
// final classification included.
void BM_window(benchmark::State& state) {
  SyntheticWindowOptions options;
  options.outlier_share = 0.03;
  SyntheticWindow window = synthetic_window(options);
  const std::vector<Se3> poses = window.problem.poses;
  const std::vector<Eigen::Vector3d> landmarks = window.problem.landmarks;
  BundleOptions solve;
  solve.relative_tolerance = 0;
  SolveReport report;
  for (auto _ : state) {
    window.problem.poses = poses;
    window.problem.landmarks = landmarks;
    report = solve_bundle(window.problem, solve);
    benchmark::DoNotOptimize(report);
  }
  state.counters["iterations"] = report.iterations;
  state.counters["accepted"] = report.accepted;
  state.counters["observations"] = static_cast<double>(window.problem.observations.size());
}
BENCHMARK(BM_window)->Unit(benchmark::kMillisecond)->Repetitions(5)->ReportAggregatesOnly();

// The joint window: 25 keyframes (5 fixed), 3,000 landmarks, 15,000 observations and `planes` seen by all of them,
// 5 iterations. 0 planes: what the landmarks alone cost.
void BM_window_with_planes(benchmark::State& state) {
  SyntheticWindowOptions options;
  options.fixed_poses = 5;
  SyntheticWindow window = synthetic_window(options);
  Rng rng(1, "solve_benchmark", 2);
  StructureVariables& structures = window.problem.structures;
  for (int p = 0; p < static_cast<int>(state.range(0)); ++p) {
    const Eigen::Vector3d normal = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const AnchoredPlane truth{normal, 3 * normal, 0};
    structures.planes.push_back(truth.retract({0.02 * rng.normal(), 0.02 * rng.normal(), 0.02}));
    for (std::size_t i = 0; i < window.true_poses.size(); ++i) {
      const AnchoredPlane seen = truth.transformed(window.true_poses[i].inverse());
      const Eigen::Vector3d noise(0.005 * rng.normal(), 0.005 * rng.normal(), 0.005 * rng.normal());
      window.problem.factors.push_back(std::make_unique<PlaneObservationFactor>(
          static_cast<int>(i), p, PlaneEstimate{seen.retract(noise), 4e4 * Eigen::Matrix3d::Identity()}));
    }
  }
  const BundleProblem& problem = window.problem;
  const std::vector<Se3> poses = problem.poses;
  const std::vector<Eigen::Vector3d> landmarks = problem.landmarks;
  const std::vector<AnchoredPlane> planes = structures.planes;
  BundleOptions solve;
  solve.relative_tolerance = 0;
  SolveReport report;
  for (auto _ : state) {
    window.problem.poses = poses;
    window.problem.landmarks = landmarks;
    structures.planes = planes;
    report = solve_bundle(window.problem, solve);
    benchmark::DoNotOptimize(report);
  }
  state.counters["iterations"] = report.iterations;
  state.counters["observations"] = static_cast<double>(problem.observations.size());
  state.counters["plane_factors"] = static_cast<double>(problem.factors.size());
}
BENCHMARK(BM_window_with_planes)
    ->Arg(0)
    ->Arg(10)
    ->Unit(benchmark::kMillisecond)
    ->Repetitions(5)
    ->ReportAggregatesOnly();

// A map of 300 keyframes in a chain: sparse Cholesky.
void BM_map(benchmark::State& state) {
  SyntheticWindowOptions options;
  options.fixed_poses = 1;
  options.free_poses = static_cast<int>(state.range(0));
  options.landmarks = 50 * options.free_poses;
  SyntheticWindow window = synthetic_window(options);
  const std::vector<Se3> poses = window.problem.poses;
  const std::vector<Eigen::Vector3d> landmarks = window.problem.landmarks;
  BundleOptions solve;
  solve.relative_tolerance = 0;
  for (auto _ : state) {
    window.problem.poses = poses;
    window.problem.landmarks = landmarks;
    benchmark::DoNotOptimize(solve_bundle(window.problem, solve));
  }
}
BENCHMARK(BM_map)->Arg(150)->Arg(300)->Arg(1000)->Unit(benchmark::kMillisecond);

// Pose of one frame from 600 matches, a sixth of them wrong, from a prediction off by 2 cm and 0.6 deg.
void BM_pose(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const SyntheticView view = synthetic_view(count, count / 6);
  Rng rng(1, "solve_benchmark", 0);
  const Se3 start = view.world_from_camera.retract(random_tangent(rng, 0.02, 0.01));
  PoseSolution solution;
  for (auto _ : state) {
    solution = solve_pose(Intrinsics{}, start, view.observations);
    benchmark::DoNotOptimize(solution);
  }
  state.counters["iterations"] = solution.iterations;
  state.counters["inliers"] = solution.inliers;
}
BENCHMARK(BM_pose)
    ->Arg(150)
    ->Arg(600)
    ->Arg(1200)
    ->Unit(benchmark::kMicrosecond)
    ->Repetitions(3)
    ->ReportAggregatesOnly();

// Pose without prediction: 200 matches, half of them wrong.
void BM_align_matches(benchmark::State& state) {
  const SyntheticView view = synthetic_view(200, 100);
  for (auto _ : state) {
    benchmark::DoNotOptimize(align_matches(Intrinsics{}, view.observations, Rng(1, "solve_benchmark", 1)));
  }
}
BENCHMARK(BM_align_matches)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vsgraphs
