#include "core/solve/bundle_adjustment.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/solve/bundle/pattern.h"
#include "core/solve/bundle/validate.h"

namespace vsgraphs {
namespace {

// Bounds of the damping's diagonal and of lambda. The upper bound of lambda ends a search that only meets rejections.
constexpr double min_diagonal = 1e-3;
constexpr double min_lambda = 1e-10, max_lambda = 1e8;

struct State {
  std::vector<Se3> poses;
  std::vector<Eigen::Vector3d> landmarks;
  StructureVariables structures;
};

class LevenbergMarquardt {
 public:
  LevenbergMarquardt(const BundleProblem& problem, const BundleOptions& options);

  double cost(const State& state) {
    return landmarks_.cost(state.poses, state.landmarks) + dense_.cost({state.poses, state.structures});
  }
  void run(int budget, const std::function<bool()>& stop, SolveReport& report);
  std::vector<ObservationFit> classify_all(const BundleProblem& problem) const {
    return landmarks_.classify_all(state_.poses, state_.landmarks, problem.observations);
  }
  void drop(const std::vector<ObservationFit>& fit) { landmarks_.drop(fit); }
  const State& state() const { return state_; }

 private:
  void linearise();
  // Solves for the step under the current damping and moves to trial_; false if the system cannot be solved.
  bool propose(double& predicted_decrease);

  const BundleOptions& options_;
  State state_, trial_;
  VariableOrder order_;
  LandmarkPart landmarks_;
  DensePart dense_;
  BlockMatrix pattern_;
  std::unique_ptr<ReducedSolver> solver_;
  std::vector<double> normal_, reduced_;  // block values: undamped, and damped with the landmarks eliminated
  Eigen::VectorXd b_, reduced_b_, step_, diagonal_;
  double lambda_, lambda_growth_ = 2;
};

LevenbergMarquardt::LevenbergMarquardt(const BundleProblem& problem, const BundleOptions& options)
    : options_(options),
      state_{problem.poses, problem.landmarks, problem.structures},
      trial_(state_),
      order_(problem),
      landmarks_(problem, order_.pose, options),
      dense_(problem, order_),
      lambda_(std::clamp(options.initial_lambda, min_lambda, max_lambda)) {
  build_pattern(order_, dense_, landmarks_, pattern_);
  normal_.resize(pattern_.value_count());
  reduced_.resize(pattern_.value_count());
  solver_ = std::make_unique<ReducedSolver>(pattern_, pattern_.variables() > options.max_dense_poses);
}

void LevenbergMarquardt::linearise() {
  std::fill(normal_.begin(), normal_.end(), 0.0);
  b_.setZero(pattern_.scalars());
  landmarks_.linearise(state_.poses, state_.landmarks, normal_.data(), b_);
  dense_.linearise({state_.poses, state_.structures}, pattern_, normal_.data(), b_);
  diagonal_.resize(pattern_.scalars());
  for (int v = 0; v < pattern_.variables(); ++v) {
    const double* block = normal_.data() + pattern_.value_begin(pattern_.diagonal(v));
    const int dim = pattern_.dim(v);
    for (int i = 0; i < dim; ++i)
      diagonal_[pattern_.offset(v) + i] = std::max(block[i * dim + i], min_diagonal);
  }
}

bool LevenbergMarquardt::propose(double& predicted_decrease) {
  std::copy(normal_.begin(), normal_.end(), reduced_.begin());
  for (int v = 0; v < pattern_.variables(); ++v) {
    double* block = reduced_.data() + pattern_.value_begin(pattern_.diagonal(v));
    const int dim = pattern_.dim(v);
    for (int i = 0; i < dim; ++i) block[i * dim + i] += lambda_ * diagonal_[pattern_.offset(v) + i];
  }
  reduced_b_ = b_;
  landmarks_.eliminate(lambda_, reduced_.data(), reduced_b_);
  if (!solver_->solve(reduced_.data(), reduced_b_, step_)) return false;
  predicted_decrease = 0.5 * step_.dot(b_ + lambda_ * diagonal_.cwiseProduct(step_)) +
                       landmarks_.back_substitute(lambda_, step_, state_.landmarks, trial_.landmarks);
  retract(order_, pattern_, step_, state_.poses, state_.structures, trial_.poses, trial_.structures);
  return std::isfinite(predicted_decrease);
}

void LevenbergMarquardt::run(int budget, const std::function<bool()>& stop, SolveReport& report) {
  double current = cost(state_);
  bool fresh = false;
  report.converged = false;
  for (int i = 0; i < budget && lambda_ < max_lambda; ++i) {
    if (stop && stop()) {
      report.stopped = true;
      break;
    }
    if (!fresh) linearise();
    fresh = true;
    ++report.iterations;
    double predicted = 0;
    const bool solved = propose(predicted);
    const double trial_cost = solved ? cost(trial_) : current;
    const double decrease = current - trial_cost;
    if (solved && std::isfinite(trial_cost) && decrease >= 0 && predicted > 0) {
      std::swap(state_, trial_);
      ++report.accepted;
      fresh = false;
      const double gain = decrease / predicted;
      lambda_ = std::max(min_lambda, lambda_ * std::max(1.0 / 10, 1 - std::pow(2 * gain - 1, 3)));
      lambda_growth_ = 2;
      current = trial_cost;
      report.converged = decrease <= options_.relative_tolerance * (current + decrease);
      if (report.converged) break;
    } else {
      report.converged = solved && predicted <= 1e-12 * current;
      if (report.converged) break;
      lambda_ *= lambda_growth_;
      lambda_growth_ *= 2;
    }
  }
  report.final_cost = current;
}

}  // namespace

SolveReport solve_bundle(BundleProblem& problem, const BundleOptions& options,
                         const std::function<bool()>& stop) {
  validate(problem, options);
  SolveReport report;
  LevenbergMarquardt solver(problem, options);
  State initial;
  report.initial_cost = solver.cost(solver.state());
  if (options.iterations_before_dropping > 0) {
    initial = solver.state();
    solver.run(options.iterations_before_dropping, stop, report);
    if (!report.stopped) {
      solver.drop(solver.classify_all(problem));
      report.initial_cost = solver.cost(initial);
    }
  }
  if (!report.stopped) solver.run(options.max_iterations, stop, report);
  report.fit = solver.classify_all(problem);
  report.outliers =
      static_cast<int>(std::count(report.fit.begin(), report.fit.end(), ObservationFit::outlier));
  problem.poses = solver.state().poses;
  problem.landmarks = solver.state().landmarks;
  problem.structures = solver.state().structures;
  return report;
}

}  // namespace vsgraphs
