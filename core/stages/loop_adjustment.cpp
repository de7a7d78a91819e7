#include "core/stages/loop_adjustment.h"

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
  window_ = whole_map(*snapshot_);
  problem_ = build_problem(*snapshot_, window_, model_);
  report_ = solve_bundle(problem_.bundle, options_, stop);
  return !report_.stopped;
}

MapEdit FullAdjustment::edit() const {
  Draft draft(snapshot_);
  apply_solution(window_, problem_, report_, draft);
  return draft.take();
}

}  // namespace vsgraphs
