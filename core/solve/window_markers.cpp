#include "core/solve/window_markers.h"

#include <algorithm>
#include <set>

#include "core/geometry/pose_covariance.h"
#include "core/solve/factors/marker_pose.h"
#include "core/solve/factors/pose_prior.h"
#include "core/solve/pose_graph.h"

namespace vsgraphs {
namespace {

// What the detector's covariance does not know: calibration, paper that is not flat, a print that is not to size.
const Matrix6d print_error = isotropic_covariance(0.005, 0.005);
// What the pose of a keyframe outside the window may be off by.
const Matrix6d outer_pose_error = isotropic_covariance(0.03, 0.01);

struct SeenMarker {
  KeyframeId keyframe;  // living
  int pose;             // in the problem; -1: outside
  Se3 seen;             // in that keyframe's frame
  Matrix6d covariance;
};

class MarkerGathering {
 public:
  MarkerGathering(const Map& map, const WindowProblem& problem)
      : map_(map), problem_(problem), pose_of_(pose_positions(map, problem)) {}

  bool is_free(int pose) const {
    return pose >= 0 && !problem_.bundle.pose_fixed[static_cast<std::size_t>(pose)];
  }
  // In the problem, -1 outside, of the living keyframe that stands for `id`.
  int pose_of(KeyframeId id) const {
    const auto living = map_.reanchor({id, Se3{}});
    return living ? pose_of_[living->keyframe.index] : -1;
  }

  std::vector<SeenMarker> seen(const MappedMarker& marker, const MarkerSightings& sightings) const {
    std::vector<SeenMarker> result;
    for (const std::size_t i : sightings.places.front().observations) {
      const MarkerObservation& o = marker.observations[i];
      const auto living = map_.reanchor({o.keyframe, o.camera_from_marker});
      result.push_back({living->keyframe, pose_of_[living->keyframe.index], living->keyframe_from_camera,
                        o.covariance + print_error});
    }
    return result;
  }

  // Whether it can say anything: a free pose sees it, and not one keyframe alone.
  bool ties(const std::vector<SeenMarker>& seen) const {
    const bool free =
        std::any_of(seen.begin(), seen.end(), [this](const auto& s) { return is_free(s.pose); });
    const bool alone = std::all_of(seen.begin(), seen.end(),
                                   [&seen](const auto& s) { return s.keyframe == seen.front().keyframe; });
    return free && !alone;
  }

 private:
  const Map& map_;
  const WindowProblem& problem_;
  std::vector<int> pose_of_;
};

void add_factors(const Map& map, const std::vector<SeenMarker>& seen, int index, WindowProblem& problem) {
  const auto outside = std::count_if(seen.begin(), seen.end(), [](const auto& s) { return s.pose < 0; });
  for (const SeenMarker& s : seen) {
    if (s.pose >= 0) {
      problem.bundle.factors.push_back(std::make_unique<MarkerPose>(
          s.pose, index, s.seen, square_root_of_information(information_of(s.covariance))));
      continue;
    }
    const Se3& placed = map.keyframes().find(s.keyframe)->world_from_camera;
    const Matrix6d covariance = compose_covariance(outer_pose_error, s.seen, s.covariance);
    // The errors of their poses are much the same.
    const Matrix6d information = information_of(covariance) / static_cast<double>(outside);
    problem.bundle.factors.push_back(
        std::make_unique<PosePrior>(VariableRef{VariableKind::marker, index}, placed * s.seen,
                                    square_root_of_information(information), huber_of_marker));
  }
}

}  // namespace

void build_marker_factors(const Map& map, const Window&, const MeasurementModel& model,
                          WindowProblem& problem) {
  if (!model.factors.marker_pose) return;
  const MarkerGathering gathering(map, problem);
  for (const auto& [id, marker] : map.markers()) {
    const MarkerSightings sightings = map.sightings(*marker);
    if (sightings.places.empty() || sightings.in_two_places()) continue;
    const std::vector<SeenMarker> seen = gathering.seen(*marker, sightings);
    if (!gathering.ties(seen)) continue;
    const int index = static_cast<int>(problem.bundle.structures.markers.size());
    problem.bundle.structures.markers.push_back(marker->world_from_marker);
    problem.marker_of_variable.push_back(id);
    add_factors(map, seen, index, problem);
  }
}

void move_passenger_markers(const WindowProblem& problem, const Corrections& corrections, Draft& draft) {
  const Map& map = draft.map();
  const Carry carry(map, corrections);
  const MarkerGathering gathering(map, problem);
  std::vector<MoveMarker> moves;
  const std::set<MarkerId> solved(problem.marker_of_variable.begin(), problem.marker_of_variable.end());
  for (const auto& [id, marker] : map.markers()) {
    if (solved.contains(id)) continue;
    const auto carrier = carrier_of(map, *marker);
    if (!carrier || !gathering.is_free(gathering.pose_of(*carrier))) continue;
    if (const auto move = carry.marker(id)) moves.push_back(*move);
  }
  for (MoveMarker& move : moves) draft.record(std::move(move));
}

}  // namespace vsgraphs
