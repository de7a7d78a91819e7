#include "core/mapping/local_mapper.h"

#include <algorithm>

#include "core/mapping/landmark_creation.h"
#include "core/mapping/odometry.h"
#include "core/matching/appearance.h"
#include "core/matching/landmark_fusion.h"

namespace vsgraphs {

LocalMapper::LocalMapper(const LocalMapperOptions& options, const Camera& camera, const ScalePyramid& pyramid,
                         const FactorSwitches& factors)
    : options_(options), camera_(camera), pyramid_(pyramid), model_{camera, pyramid.factor, factors} {}

MapEdit LocalMapper::insert(const KeyframeRequest& request, const Snapshot& snapshot, KeyframeId& id,
                            TraceSink* trace) {
  const Span span(trace, "insert_keyframe");
  Draft draft(snapshot);
  Keyframe keyframe;
  keyframe.frame_index = request.frame_index;
  keyframe.timestamp_s = request.timestamp_s;
  keyframe.features = request.features;
  keyframe.surface = request.surface;
  keyframe.tracked_link = request.tracked_link;
  if (!request.first) {
    const auto pose = draft.map().resolve(request.pose);
    VSG_INVARIANT(pose.has_value());
    keyframe.world_from_camera = *pose;
    keyframe.stretch =
        stretch_going_on(draft.map(), *pose, request.landmarks, request.tracked_link, options_.stretch_way_m);
  }
  id = draft.add(std::move(keyframe));
  ++keyframe_count_;
  take_over_observations(request, id, draft);

  std::vector<LandmarkId> made;
  if (!request.first) {
    const auto neighbours = neighbours_of(draft.map(), id, options_.fusion_neighbours);
    observe_neighbours_landmarks(camera_, pyramid_, id, neighbours, draft);
    made = create_by_triangulation(camera_, pyramid_, id,
                                   neighbours_of(draft.map(), id, options_.triangulation_neighbours), draft);
  }
  const auto from_depth = create_from_depth(camera_, id, draft);
  made.insert(made.end(), from_depth.begin(), from_depth.end());
  probation_.admit(made, keyframe_count_);
  if (!request.first) {
    fuse_into_neighbours(camera_, pyramid_, id, neighbours_of(draft.map(), id, options_.fusion_neighbours),
                         draft);
    refresh_appearance(id, draft);
  }
  return draft.take();
}

void LocalMapper::take_over_observations(const KeyframeRequest& request, KeyframeId keyframe, Draft& draft) {
  for (const Sighting& s : request.sightings) {
    const LandmarkId landmark = draft.map().landmarks().resolve(s.landmark);
    if (landmark.valid()) draft.record(CountSightings{landmark, s.visible, s.found});
  }
  for (std::size_t i = 0; i < request.landmarks.size(); ++i) {
    const LandmarkId landmark = draft.map().landmarks().resolve(request.landmarks[i]);
    if (landmark.valid()) draft.record(AddObservation{landmark, {keyframe, static_cast<std::uint16_t>(i)}});
  }
}

std::vector<KeyframeId> LocalMapper::neighbours_of(const Map& map, KeyframeId keyframe, int count) const {
  constexpr int min_shared = 10;
  std::vector<KeyframeId> result;
  if (const auto link = map.living_link(keyframe)) result.push_back(link->to);
  for (const auto& [id, shared] : map.covisible(keyframe, min_shared)) {
    if (static_cast<int>(result.size()) >= count) break;
    if (result.empty() || id != result.front()) result.push_back(id);
  }
  return result;
}

void LocalMapper::refresh_appearance(KeyframeId keyframe, Draft& draft) const {
  const std::vector<LandmarkId> landmarks = draft.map().keyframes().find(keyframe)->landmarks;
  for (const LandmarkId id : landmarks) {
    const Landmark* landmark = draft.map().landmarks().find(id);
    if (!landmark || landmark->observations.size() < 2) continue;
    if (auto appearance = summarise_appearance(draft.map(), *landmark)) {
      draft.record(SetAppearance{id, *appearance});
    }
  }
}

// Keyframes held by surfaces share no landmarks: where the newest has no link to them no window holds them. The last few before it.
void LocalMapper::add_linked(const Map& map, KeyframeId keyframe, std::vector<KeyframeId>& candidates) const {
  constexpr int looked_at = 12;
  int seen = 0;
  for (std::uint32_t index = keyframe.index; index-- > 0 && seen < looked_at;) {
    const KeyframeId id = map.keyframes().at_index(index);
    if (!id.valid()) continue;
    ++seen;
    if (map.keyframes().find(id)->tracked_link &&
        std::find(candidates.begin(), candidates.end(), id) == candidates.end())
      candidates.push_back(id);
  }
}

MapEdit LocalMapper::refine(KeyframeId keyframe, const Snapshot& snapshot, const std::function<bool()>& stop,
                            SolveReport& report, TraceSink* trace) {
  Draft draft(snapshot);
  const Window window =
      select_window(draft.map(), keyframe, options_.window_keyframes, options_.window_witnesses);
  if (draft.map().keyframes().size() > 1) {
    const Span span(trace, "local_adjustment");
    WindowProblem problem = build_problem(draft.map(), window, model_);
    BundleOptions bundle;
    bundle.iterations_before_dropping = options_.iterations_before_dropping;
    bundle.max_iterations = options_.iterations;
    report = solve_bundle(problem.bundle, bundle, stop);
    apply_solution(window, problem, report, draft);
  }
  const Span span(trace, "cull");
  probation_.judge(options_.culling, keyframe_count_, draft);
  std::vector<KeyframeId> candidates;
  for (const KeyframeId id : window.free) {
    if (id != keyframe) candidates.push_back(id);
  }
  add_linked(draft.map(), keyframe, candidates);
  cull_keyframes(options_.culling, candidates, draft);
  const Span measuring(trace, "odometry");
  measure_odometry(model_, window, keyframe, draft);
  return draft.take();
}

}  // namespace vsgraphs
