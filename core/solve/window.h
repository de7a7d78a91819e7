// Which part of the map one local adjustment improves, as data; and the two ways between map and problem.
// Window: Mur-Artal, Montiel, Tardos, T-RO 2015, section VI-D (covisible keyframes free, their witnesses fixed).
#pragma once

#include <vector>

#include "core/geometry/camera.h"
#include "core/map/carry.h"
#include "core/map/draft.h"
#include "core/map/map.h"
#include "core/solve/bundle_adjustment.h"
#include "core/solve/factor_switches.h"

namespace vsgraphs {

struct Window {
  std::vector<KeyframeId> free;        // poses to improve
  std::vector<KeyframeId> fixed;       // poses that hold the rest in place
  std::vector<LandmarkId> landmarks;   // seen by at least two keyframes
  std::vector<LandmarkId> passengers;  // seen by one free keyframe alone: they move with it
};

// The keyframes covisible with `centre` (most shared landmarks first), up to the given numbers. Without any
// outer keyframe the oldest of the window is fixed. Deterministic; cost linear in the window's observations.
Window select_window(const Map& map, KeyframeId centre, int max_free, int max_fixed);

// How reliable a measurement is, by the pyramid level it was made at and the sensor's noise; and which kinds count.
struct MeasurementModel {
  Camera camera;
  double scale_factor = 1.2;  // of the pyramid; a feature is as good as a pixel of its level
  FactorSwitches factors;
};

// The window as an optimisation problem, with the way back.
struct WindowProblem {
  BundleProblem bundle;
  std::vector<KeyframeId> keyframe_of_pose;
  std::vector<LandmarkId> landmark_of_point;
  std::vector<PlaneId> plane_of_variable;
  std::vector<int> room_of_centroid;  // index into the map's rooms; these centroids come first
  std::vector<std::pair<int, int>> floor_of_centroid;  // (centroid, index into the map's floors)
  std::vector<MarkerId> marker_of_variable;
};

// Per keyframe index, the keyframe's pose in the problem; -1 where it has none.
std::vector<int> pose_positions(const Map& map, const WindowProblem& problem);

// What the solution moves each keyframe by; identity for those that are fixed or outside. `map` has the poses of before.
Corrections corrections_of(const Map& map, const WindowProblem& problem);

// Walks the table of factor builders: landmarks, tracked links, planes, walls on their ground, rooms and floors,
// markers.
WindowProblem build_problem(const Map& map, const Window& window, const MeasurementModel& model);

// Landmarks alone: what the window's keyframes saw themselves, and nothing that the map makes of it.
WindowProblem build_landmark_problem(const Map& map, const Window& window, const MeasurementModel& model);

// Records the solution in `draft`: moved poses, landmarks, passengers, planes and markers, and removes the
// observations that `report` calls outliers.
void apply_solution(const Window& window, const WindowProblem& problem, const SolveReport& report,
                    Draft& draft);

}  // namespace vsgraphs
