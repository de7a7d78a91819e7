#include "core/stages/loop_adjustment.h"

#include <algorithm>

namespace vsgraphs {

Window whole_map(const Map& map) {
  Window window;
  map.keyframes().for_each([&window](KeyframeId id, const Keyframe&) {
    (window.fixed.empty() ? window.fixed : window.free).push_back(id);
  });
  map.landmarks().for_each([&window](LandmarkId id, const Landmark& landmark) {
    if (landmark.observations.empty()) return;
    (landmark.observations.size() >= 2 ? window.landmarks : window.passengers).push_back(id);
  });
  return window;
}

FullAdjustment::FullAdjustment(Snapshot snapshot, const MeasurementModel& model, int settle_iterations)
    : snapshot_(std::move(snapshot)),
      window_(whole_map(*snapshot_)),
      problem_(build_problem(*snapshot_, window_, model)),
      settle_iterations_(settle_iterations) {}

bool FullAdjustment::advance(int iterations, const std::function<bool()>& stop) {
  while (iterations > 0) {
    BundleOptions options;
    const int until_settled = settle_iterations_ - iterations_;
    options.max_iterations = settled_ ? iterations : std::min(iterations, until_settled);
    if (options.max_iterations > 0) {
      report_ = solve_bundle(problem_.bundle, options, stop);
      iterations_ += report_.iterations;
      iterations -= report_.iterations;
      if (report_.stopped) return false;
      if (settled_) return !report_.converged && report_.accepted > 0;
    }
    if (iterations_ >= settle_iterations_ || report_.converged || report_.iterations == 0) drop_outliers();
  }
  return true;
}

void FullAdjustment::drop_outliers() {
  settled_ = true;
  auto& observations = problem_.bundle.observations;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < report_.fit.size(); ++i) {
    ReprojectionObservation o = observations[i];
    if (!is_inlier(report_.fit[i])) {
      dropped_.emplace_back(problem_.landmark_of_point[static_cast<std::size_t>(o.landmark)],
                            problem_.keyframe_of_pose[static_cast<std::size_t>(o.pose)]);
      continue;
    }
    if (report_.fit[i] == ObservationFit::pixel_only) o.inverse_depth = 0;
    observations[kept++] = o;
  }
  if (!report_.fit.empty()) observations.resize(kept);
  report_.fit.assign(observations.size(), ObservationFit::inlier);
}

MapEdit FullAdjustment::edit() const {
  Draft draft(snapshot_);
  for (const auto& [landmark, keyframe] : dropped_) draft.record(RemoveObservation{landmark, keyframe});
  SolveReport report = report_;
  report.fit.resize(problem_.bundle.observations.size(), ObservationFit::inlier);
  apply_solution(window_, problem_, report, draft);
  return draft.take();
}

}  // namespace vsgraphs
