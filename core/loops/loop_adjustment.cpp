#include "core/loops/loop_adjustment.h"

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

FullAdjustment::FullAdjustment(Snapshot snapshot, const MeasurementModel& model, const BundleOptions& options)
    : snapshot_(std::move(snapshot)), model_(model), options_(options) {}

bool FullAdjustment::run(const std::function<bool()>& stop, TraceSink* trace) {
  const Span span(trace, "full_adjustment");
  const Window window = whole_map(*snapshot_);
  WindowProblem problem = build_problem(*snapshot_, window, model_);
  report_ = solve_bundle(problem.bundle, options_, stop);
  if (report_.stopped) return false;
  Draft draft(snapshot_);
  apply_solution(window, problem, report_, draft);
  // Windows may move it meanwhile; all others were worked out as seen from here.
  for (const KeyframeId id : window.fixed)
    draft.record(MoveKeyframe{id, snapshot_->keyframes().find(id)->world_from_camera});
  edit_ = draft.take();
  return true;
}

}  // namespace vsgraphs
