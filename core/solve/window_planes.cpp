#include "core/solve/window_planes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/solve/condense_observations.h"
#include "core/solve/factors/plane_observation.h"
#include "core/solve/factors/plane_perpendicular.h"
#include "core/solve/factors/plane_prior.h"
#include "core/solve/structure_gate.h"

namespace vsgraphs {
namespace {

// What is common to all readings of a frame: depth and colour are not taken at one time, and the sensor's depth is off by
// a smooth error of its own.
constexpr FrameTolerance frame_error{0.01, 0.004};
// What the pose of a keyframe outside the window may be off by.
constexpr FrameTolerance outer_pose_error{0.03, 0.01};

// The keyframe that alone has seen the plane; invalid if there are several or none.
KeyframeId only_observer_of(const MappedPlane& plane) {
  if (plane.observations.empty()) return {};
  const KeyframeId first = plane.observations.front().keyframe;
  const bool alone = std::all_of(plane.observations.begin(), plane.observations.end(),
                                 [&](const PlaneObservation& o) { return o.keyframe == first; });
  return alone ? first : KeyframeId{};
}

struct SeenByPose {
  int pose;
  PlaneEstimate seen;  // in that pose's frame
};

class PlaneGathering {
 public:
  PlaneGathering(const Map& map, const WindowProblem& problem)
      : map_(map), problem_(problem), pose_of_(pose_positions(map, problem)) {
    std::set<KeyframeId> stretches;
    for (const KeyframeId id : problem.keyframe_of_pose) stretches.insert(map.stretch_of(id));
    const auto& all = map.retired_keyframes();
    near_.resize(all.index_bound());
    for (std::uint32_t index = 0; index < all.index_bound(); ++index) {
      const KeyframeId id = all.at_index(index);
      near_[index] = id.valid() && stretches.contains(map.stretch_of(id));
    }
  }

  // Sorts a plane's observations; false if no free pose sees it, unless it is `wanted` all the same.
  bool gather(const MappedPlane& plane, bool wanted) {
    inside_.clear();
    outside_.clear();
    free_ = false;
    if (only_observer_of(plane).valid()) return false;
    far_.clear();
    for (const PlaneObservation& o : plane.observations) {
      if (near_[o.keyframe.index])
        take(o, 1);
      else
        far_.push_back(&o);
    }
    take_far();
    return free_ || wanted;
  }
  const std::vector<SeenByPose>& inside() const { return inside_; }
  const std::vector<WeightedPlane>& outside() const { return outside_; }
  // Among the patches the window sees, so that turning the plane there moves it little.
  Eigen::Vector3d anchor(const MappedPlane& plane) const {
    if (inside_.empty()) return plane.plane.project(plane.plane.anchor);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const SeenByPose& s : inside_)
      sum += problem_.bundle.poses[static_cast<std::size_t>(s.pose)] * s.seen.plane.anchor;
    return plane.plane.project(sum / static_cast<double>(inside_.size()));
  }

 private:
  // Of what was seen of it in other stretches, some speak for all, each for its neighbours in time: they saw it from much the same
  // place, and what a window costs must not grow with all that was ever seen.
  void take_far() {
    constexpr std::size_t enough = 64;
    const std::size_t step = 1 + far_.size() / enough;
    for (std::size_t i = 0; i < far_.size(); i += step)
      take(*far_[i], static_cast<double>(std::min(step, far_.size() - i)));
  }
  void take(const PlaneObservation& o, double weight) {
    const SurfacePatch* patch = map_.patch(o);
    const auto living = map_.reanchor({o.keyframe, Se3{}});
    if (!patch || !living) return;
    const PlaneEstimate seen =
        plane_estimate(*patch).inflated(frame_error).transformed(living->keyframe_from_camera);
    const int pose = pose_of_[living->keyframe.index];
    const bool fixed = pose >= 0 && problem_.bundle.pose_fixed[static_cast<std::size_t>(pose)];
    if (pose >= 0 && !fixed) {
      free_ = true;
      inside_.push_back({pose, seen});
    } else {
      const Se3& placed = map_.keyframes().find(living->keyframe)->world_from_camera;
      outside_.push_back({(fixed ? seen : seen.inflated(outer_pose_error)).transformed(placed), weight});
    }
  }

  const Map& map_;
  const WindowProblem& problem_;
  std::vector<int> pose_of_;
  std::vector<std::uint8_t> near_;  // by keyframe index: of a stretch with a keyframe in the window
  std::vector<const PlaneObservation*> far_;
  bool free_ = false;
  std::vector<SeenByPose> inside_;
  std::vector<WeightedPlane> outside_;
};

}  // namespace

namespace {

// Walls and ground of the rooms that have a wall in the window: tied to it, they come along with what is known of them.
std::vector<PlaneId> planes_of_rooms_in_window(const Map& map, PlaneGathering& gathering) {
  std::vector<PlaneId> planes;
  for (const FoundRoom& room : map.structure().rooms) {
    const bool seen = std::any_of(room.walls.begin(), room.walls.end(), [&](PlaneId id) {
      const MappedPlane* wall = map.planes().find(id);
      return wall && gathering.gather(*wall, false);
    });
    if (!seen) continue;
    planes.insert(planes.end(), room.walls.begin(), room.walls.end());
    if (room.ground.valid()) planes.push_back(room.ground);
  }
  std::sort(planes.begin(), planes.end());
  return planes;
}

}  // namespace

void build_plane_factors(const Map& map, const Window&, const MeasurementModel& model,
                         WindowProblem& problem) {
  PlaneGathering gathering(map, problem);
  const std::vector<PlaneId> wanted = planes_of_rooms_in_window(map, gathering);
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    if (!gathering.gather(plane, std::binary_search(wanted.begin(), wanted.end(), id))) return;
    const int index = static_cast<int>(problem.bundle.structures.planes.size());
    const AnchoredPlane start = plane.plane.anchored_at(gathering.anchor(plane));
    problem.bundle.structures.planes.push_back(start);
    problem.plane_of_variable.push_back(id);
    for (const SeenByPose& s : gathering.inside()) {
      if (model.factors.plane_observation)
        problem.bundle.factors.push_back(std::make_unique<PlaneObservationFactor>(s.pose, index, s.seen));
    }
    if (!model.factors.plane_prior) return;
    if (const auto known = condense_observations(gathering.outside(), start))
      problem.bundle.factors.push_back(std::make_unique<PlanePrior>(index, *known, huber_3dof));
  });
}

void build_wall_to_ground_factors(const Map& map, const Window&, const MeasurementModel& model,
                                  WindowProblem& problem) {
  if (!map.up_in_world() || !model.factors.wall_upright) return;
  const Eigen::Vector3d& up = *map.up_in_world();
  const auto& planes = problem.bundle.structures.planes;
  const auto role = [&](std::size_t i) { return map.planes().find(problem.plane_of_variable[i])->role; };
  constexpr AngleGate gate;
  for (std::size_t wall = 0; wall < planes.size(); ++wall) {
    if (role(wall) != SurfaceRole::wall) continue;
    int nearest = -1;
    double nearest_m = 0;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      if (role(i) != SurfaceRole::ground) continue;
      const double above_m = std::abs(up.dot(planes[wall].anchor - planes[i].anchor));
      if (nearest >= 0 && above_m >= nearest_m) continue;
      nearest = static_cast<int>(i);
      nearest_m = above_m;
    }
    if (nearest < 0) continue;
    const double deviation = deviation_from_perpendicular_rad(
        planes[wall].normal, planes[static_cast<std::size_t>(nearest)].normal);
    if (!gate.holds(true, deviation)) continue;
    problem.bundle.factors.push_back(
        std::make_unique<PlanePerpendicular>(static_cast<int>(wall), nearest, PlaneAngle{}));
  }
}

void move_passenger_planes(const WindowProblem& problem, const Corrections& corrections, Draft& draft) {
  const Map& map = draft.map();
  const Carry carry(map, corrections);
  const std::vector<int> pose_of = pose_positions(map, problem);
  std::vector<MovePlane> moves;
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    const auto living = map.reanchor({only_observer_of(plane), Se3{}});
    const int pose = living ? pose_of[living->keyframe.index] : -1;
    if (pose < 0 || problem.bundle.pose_fixed[static_cast<std::size_t>(pose)]) return;
    if (const auto move = carry.plane(id)) moves.push_back(*move);
  });
  for (MovePlane& move : moves) draft.record(std::move(move));
}

}  // namespace vsgraphs
