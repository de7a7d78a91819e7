#include "core/mapping/odometry.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <vector>

#include "core/geometry/pose_covariance.h"
#include "core/solve/marginals.h"

namespace vsgraphs {

namespace {

constexpr int min_shared = 15;      // landmarks that both saw; fewer do not hold a step
constexpr int neighbours = 2;       // in time, on either side: they saw the same landmarks
constexpr std::size_t at_most = 4;  // steps measured in one go
// What is known worse is not known.
constexpr double max_sigma_m = 0.3, max_sigma_rad = 0.2;

// The next living keyframe before (-1) or after (1) in time.
KeyframeId next_to(const Map& map, KeyframeId id, int direction) {
  const auto bound = static_cast<std::int64_t>(map.keyframes().index_bound());
  for (std::int64_t index = std::int64_t{id.index} + direction; index >= 0 && index < bound;
       index += direction) {
    if (const KeyframeId other = map.keyframes().at_index(static_cast<std::uint32_t>(index)); other.valid())
      return other;
  }
  return {};
}

// Those next to `from` in time, as long as they belong to the stretches of the two and share enough with them to be held.
void add_neighbours(const Map& map, KeyframeId from, int direction,
                    const std::array<KeyframeId, 2>& stretches, Window& window) {
  for (int i = 0; i < neighbours; ++i) {
    from = next_to(map, from, direction);
    if (!from.valid() ||
        std::find(stretches.begin(), stretches.end(), map.stretch_of(from)) == stretches.end())
      return;
    const auto& seen = map.keyframes().find(from)->landmarks;
    const auto shared = std::count_if(seen.begin(), seen.end(), [&](LandmarkId id) {
      return id.valid() && std::binary_search(window.landmarks.begin(), window.landmarks.end(), id);
    });
    if (shared >= min_shared) window.free.push_back(from);
  }
}

// The keyframe first, the one before fixed, and the landmarks of the two.
Window window_of_step(const Map& map, KeyframeId before, KeyframeId keyframe) {
  Window window;
  window.free = {keyframe};
  window.fixed = {before};
  for (const KeyframeId id : {before, keyframe}) {
    const auto& seen = map.keyframes().find(id)->landmarks;
    std::copy_if(seen.begin(), seen.end(), std::back_inserter(window.landmarks),
                 [](LandmarkId landmark) { return landmark.valid(); });
  }
  std::sort(window.landmarks.begin(), window.landmarks.end());
  window.landmarks.erase(std::unique(window.landmarks.begin(), window.landmarks.end()),
                         window.landmarks.end());
  const std::array<KeyframeId, 2> stretches{map.stretch_of(before), map.stretch_of(keyframe)};
  add_neighbours(map, before, -1, stretches, window);
  add_neighbours(map, keyframe, 1, stretches, window);
  return window;
}

int shared_landmarks(const Map& map, KeyframeId a, KeyframeId b) {
  const auto& of_b = map.keyframes().find(b)->landmarks;
  int shared = 0;
  for (const LandmarkId id : map.keyframes().find(a)->landmarks) {
    const Landmark* landmark = map.landmarks().find(id);
    if (!landmark) continue;
    shared += std::any_of(landmark->observations.begin(), landmark->observations.end(),
                          [&](const Observation& o) { return o.keyframe == b && of_b[o.feature] == id; });
  }
  return shared;
}

// Landmarks that two poses of the problem see and neither's sight of it is an outlier.
int agreeing(const BundleProblem& problem, const SolveReport& report, int a, int b) {
  std::vector<std::uint8_t> seen(problem.landmarks.size(), 0);
  int both = 0;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const ReprojectionObservation& o = problem.observations[i];
    if ((o.pose != a && o.pose != b) || !is_inlier(report.fit[i])) continue;
    both += ++seen[static_cast<std::size_t>(o.landmark)] == 2;
  }
  return both;
}

std::optional<OdometryStep> step_in(const Map& map, const Window& window, const MeasurementModel& model) {
  BundleProblem bundle = build_landmark_problem(map, window, model).bundle;
  const int self = 0, before = static_cast<int>(bundle.poses.size()) - 1;
  const SolveReport report = solve_bundle(bundle, {.max_iterations = 2, .iterations_before_dropping = 3});
  if (agreeing(bundle, report, self, before) < min_shared) return std::nullopt;
  const auto covariance = relative_covariance(bundle, before, self, report.fit);
  if (!covariance || covariance->diagonal().head<3>().sum() > max_sigma_m * max_sigma_m ||
      covariance->diagonal().tail<3>().sum() > max_sigma_rad * max_sigma_rad)
    return std::nullopt;
  const Se3 step = bundle.poses.back().inverse() * bundle.poses.front();
  return OdometryStep{window.fixed.front(), step.normalized(), *covariance};
}

std::optional<OdometryStep> step_by_landmarks(const Map& map, KeyframeId before, KeyframeId keyframe,
                                              const MeasurementModel& model) {
  if (shared_landmarks(map, before, keyframe) < min_shared) return std::nullopt;
  Window window = window_of_step(map, before, keyframe);
  auto step = step_in(map, window, model);
  if (step || window.free.size() == 1) return step;
  window.free.resize(1);  // a neighbour that hangs loose must not cost the step
  return step_in(map, window, model);
}

// Surfaces slide along themselves: tracking knows less than it says of how, and nothing of where it could not see.
std::optional<OdometryStep> step_by_link(const Map& map, KeyframeId before, KeyframeId keyframe) {
  constexpr double slides = 0.1, noise_m = 0.005, noise_rad = 0.002;
  const auto link = map.living_link(keyframe);
  if (!link || link->to != before) return std::nullopt;
  const Se3& step = link->to_from_camera;
  const Matrix6d slide = isotropic_covariance(noise_m + slides * step.translation().norm(),
                                              noise_rad + slides * rotation_angle(step.rotation()));
  // A metre, or a radian, in directions that tracking could not see.
  return OdometryStep{before, step, covariance_of(link->information + Matrix6d::Identity()) + slide};
}

}  // namespace

OdometryStep measure_step(const Map& map, KeyframeId keyframe, const MeasurementModel& model) {
  const KeyframeId before = next_to(map, keyframe, -1);
  if (!before.valid()) return {};
  if (const auto step = step_by_landmarks(map, before, keyframe, model)) return *step;
  return step_by_link(map, before, keyframe).value_or(OdometryStep{});
}

void measure_odometry(const MeasurementModel& model, const Window& window, KeyframeId newest, Draft& draft) {
  std::vector<KeyframeId> left;
  draft.map().keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    if (keyframe.odometry || !(id < newest)) return;
    if (std::find(window.free.begin(), window.free.end(), id) == window.free.end()) left.push_back(id);
  });
  if (left.size() > at_most) left.erase(left.begin(), left.end() - at_most);
  for (const KeyframeId id : left) draft.record(SetOdometry{id, measure_step(draft.map(), id, model)});
}

}  // namespace vsgraphs
