#include "core/solve/window.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/solve/factors/relative_pose.h"
#include "core/solve/window_markers.h"
#include "core/solve/window_planes.h"
#include "core/solve/window_structure.h"

namespace vsgraphs {

namespace {

// Position of each window member in a dense array by id index; -1 where it is not a member.
template <typename IdType>
std::vector<int> positions(const std::vector<IdType>& members, std::uint32_t bound) {
  std::vector<int> position(bound, -1);
  for (std::size_t i = 0; i < members.size(); ++i) position[members[i].index] = static_cast<int>(i);
  return position;
}

void gather_landmarks(const Map& map, Window& window) {
  std::vector<std::uint8_t> seen(map.landmarks().index_bound(), 0);
  for (const KeyframeId id : window.free) {
    for (const LandmarkId landmark : map.keyframes().find(id)->landmarks) {
      if (!landmark.valid() || seen[landmark.index]) continue;
      seen[landmark.index] = 1;
      const auto& observations = map.landmarks().find(landmark)->observations;
      (observations.size() >= 2 ? window.landmarks : window.passengers).push_back(landmark);
    }
  }
}

// Witnesses: keyframes outside the window that see its landmarks, the most closely tied first.
void gather_fixed(const Map& map, Window& window, int max_fixed) {
  const std::vector<int> free = positions(window.free, map.keyframes().index_bound());
  std::vector<int> shared(map.keyframes().index_bound(), 0);
  std::vector<KeyframeId> witnesses;
  for (const LandmarkId landmark : window.landmarks) {
    for (const Observation& o : map.landmarks().find(landmark)->observations) {
      if (free[o.keyframe.index] < 0 && shared[o.keyframe.index]++ == 0) witnesses.push_back(o.keyframe);
    }
  }
  std::sort(witnesses.begin(), witnesses.end(), [&shared](KeyframeId a, KeyframeId b) {
    return shared[a.index] != shared[b.index] ? shared[a.index] > shared[b.index] : a < b;
  });
  if (witnesses.size() > static_cast<std::size_t>(max_fixed))
    witnesses.resize(static_cast<std::size_t>(max_fixed));
  window.fixed = std::move(witnesses);
}

// Keyframes that tracked links chain to the window's, as those may share no landmark with it.
void add_linked(const Map& map, Window& window, int max_free) {
  for (std::size_t i = 0; i < window.free.size() && static_cast<int>(window.free.size()) < max_free; ++i) {
    const auto link = map.living_link(window.free[i]);
    if (link && std::find(window.free.begin(), window.free.end(), link->to) == window.free.end()) {
      window.free.push_back(link->to);
    }
  }
}

ReprojectionObservation measure(const MeasurementModel& model, const Feature& feature, int pose,
                                int landmark) {
  ReprojectionObservation o;
  o.pose = pose;
  o.landmark = landmark;
  o.u = feature.u;
  o.v = feature.v;
  o.inv_sigma_px = static_cast<float>(1.0 / std::pow(model.scale_factor, feature.level));
  if (feature.has_depth()) {
    o.inverse_depth = 1.0f / feature.depth_m;
    o.inv_sigma_inverse_depth =
        static_cast<float>(inv_sigma_of_inverse_depth(model.camera.depth_noise, feature.depth_m));
  }
  return o;
}

void build_landmark_factors(const Map& map, const Window& window, const MeasurementModel& model,
                            WindowProblem& problem) {
  const std::vector<int> pose_of = pose_positions(map, problem);
  std::vector<ReprojectionObservation> rows;
  for (const LandmarkId id : window.landmarks) {
    const Landmark& landmark = *map.landmarks().find(id);
    const int index = static_cast<int>(problem.bundle.landmarks.size());
    rows.clear();
    for (const Observation& o : landmark.observations) {
      const int pose = pose_of[o.keyframe.index];
      if (pose < 0) continue;
      const Feature& feature = (*map.keyframes().find(o.keyframe)->features)[o.feature];
      rows.push_back(measure(model, feature, pose, index));
    }
    // Its other observers did not fit into the window: alone, a ray holds nothing.
    if (rows.size() < 2) continue;
    problem.bundle.landmarks.push_back(landmark.point_in_world);
    problem.landmark_of_point.push_back(id);
    problem.bundle.observations.insert(problem.bundle.observations.end(), rows.begin(), rows.end());
  }
}

// A little stiffness everywhere keeps the square root real; it is far below what any measurement says.
Matrix6d square_root(const Matrix6d& information) {
  const Matrix6d stiffened = information + 1e-6 * Matrix6d::Identity();
  return stiffened.llt().matrixU();
}

void build_tracked_links(const Map& map, const Window&, const MeasurementModel& model,
                         WindowProblem& problem) {
  if (!model.factors.tracked_link) return;
  const std::vector<int> pose_of = pose_positions(map, problem);
  for (std::size_t i = 0; i < problem.keyframe_of_pose.size(); ++i) {
    const auto link = map.living_link(problem.keyframe_of_pose[i]);
    const int other = link ? pose_of[link->to.index] : -1;
    if (other < 0) continue;
    const bool both_fixed =
        problem.bundle.pose_fixed[i] && problem.bundle.pose_fixed[static_cast<std::size_t>(other)];
    if (both_fixed) continue;
    constexpr double huber_sigmas = 3.5;  // 95 % of a chi with six degrees of freedom
    problem.bundle.factors.push_back(std::make_unique<RelativePose>(
        VariableRef{VariableKind::pose, other}, VariableRef{VariableKind::pose, static_cast<int>(i)},
        link->to_from_camera, square_root(link->information), Huber{huber_sigmas}));
  }
}

using FactorBuilder = void (*)(const Map&, const Window&, const MeasurementModel&, WindowProblem&);
constexpr std::array<FactorBuilder, 6> factor_builders = {
    build_landmark_factors,       build_tracked_links, build_plane_factors,
    build_wall_to_ground_factors, build_room_factors,  build_marker_factors};

}  // namespace

std::vector<int> pose_positions(const Map& map, const WindowProblem& problem) {
  return positions(problem.keyframe_of_pose, map.keyframes().index_bound());
}

Window select_window(const Map& map, KeyframeId centre, int max_free, int max_fixed) {
  Window window;
  window.free.push_back(centre);
  constexpr int min_shared = 15;
  for (const auto& [id, shared] : map.covisible(centre, min_shared)) {
    if (static_cast<int>(window.free.size()) >= max_free) break;
    window.free.push_back(id);
  }
  add_linked(map, window, max_free);
  gather_landmarks(map, window);
  gather_fixed(map, window, max_fixed);
  if (window.fixed.empty()) {
    const auto oldest = std::min_element(window.free.begin(), window.free.end());
    window.fixed.push_back(*oldest);
    window.free.erase(oldest);
  }
  return window;
}

Corrections corrections_of(const Map& map, const WindowProblem& problem) {
  Corrections corrections(map.keyframes().index_bound());
  for (std::size_t i = 0; i < problem.keyframe_of_pose.size(); ++i) {
    if (problem.bundle.pose_fixed[i]) continue;
    const KeyframeId id = problem.keyframe_of_pose[i];
    corrections[id.index] = problem.bundle.poses[i] * map.keyframes().find(id)->world_from_camera.inverse();
  }
  return corrections;
}

namespace {

WindowProblem poses_of(const Map& map, const Window& window, const MeasurementModel& model) {
  WindowProblem problem;
  problem.bundle.intrinsics = Intrinsics::of(model.camera);
  for (const auto* members : {&window.free, &window.fixed}) {
    for (const KeyframeId id : *members) {
      problem.keyframe_of_pose.push_back(id);
      problem.bundle.poses.push_back(map.keyframes().find(id)->world_from_camera);
      problem.bundle.pose_fixed.push_back(members == &window.fixed);
    }
  }
  return problem;
}

}  // namespace

WindowProblem build_problem(const Map& map, const Window& window, const MeasurementModel& model) {
  WindowProblem problem = poses_of(map, window, model);
  for (const FactorBuilder builder : factor_builders) builder(map, window, model, problem);
  return problem;
}

WindowProblem build_landmark_problem(const Map& map, const Window& window, const MeasurementModel& model) {
  WindowProblem problem = poses_of(map, window, model);
  build_landmark_factors(map, window, model, problem);
  return problem;
}

namespace {

void move_nodes(const WindowProblem& problem, Draft& draft) {
  if (problem.room_of_centroid.empty()) return;
  const FoundStructure& structure = draft.map().structure();
  MoveStructureNodes moved{structure.room_nodes, structure.floor_nodes};
  const auto& centroids = problem.bundle.structures.centroids;
  for (std::size_t i = 0; i < problem.room_of_centroid.size(); ++i)
    moved.rooms[static_cast<std::size_t>(problem.room_of_centroid[i])] = centroids[i];
  for (const auto& [centroid, floor] : problem.floor_of_centroid)
    moved.floors[static_cast<std::size_t>(floor)] = centroids[static_cast<std::size_t>(centroid)];
  draft.record(std::move(moved));
}

}  // namespace

void apply_solution(const Window& window, const WindowProblem& problem, const SolveReport& report,
                    Draft& draft) {
  const BundleProblem& bundle = problem.bundle;
  for (std::size_t i = 0; i < bundle.observations.size(); ++i) {
    if (is_inlier(report.fit[i])) continue;
    const ReprojectionObservation& o = bundle.observations[i];
    draft.record(RemoveObservation{problem.landmark_of_point[static_cast<std::size_t>(o.landmark)],
                                   problem.keyframe_of_pose[static_cast<std::size_t>(o.pose)]});
  }
  const Corrections corrections = corrections_of(draft.map(), problem);
  const Carry carry(draft.map(), corrections);
  for (const LandmarkId id : window.passengers) {
    if (auto move = carry.landmark(id)) draft.record(*std::move(move));
  }
  move_passenger_planes(problem, corrections, draft);
  move_passenger_markers(problem, corrections, draft);
  for (std::size_t i = 0; i < bundle.poses.size(); ++i) {
    if (!bundle.pose_fixed[i]) draft.record(MoveKeyframe{problem.keyframe_of_pose[i], bundle.poses[i]});
  }
  for (std::size_t i = 0; i < bundle.landmarks.size(); ++i) {
    draft.record(MoveLandmark{problem.landmark_of_point[i], bundle.landmarks[i]});
  }
  for (std::size_t i = 0; i < problem.plane_of_variable.size(); ++i) {
    draft.record(MovePlane{problem.plane_of_variable[i], bundle.structures.planes[i]});
  }
  for (std::size_t i = 0; i < problem.marker_of_variable.size(); ++i) {
    draft.record(MoveMarker{problem.marker_of_variable[i], bundle.structures.markers[i]});
  }
  move_nodes(problem, draft);
}

}  // namespace vsgraphs
