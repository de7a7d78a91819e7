#include "core/loops/loop_correction.h"

#include <algorithm>

#include "core/geometry/pose_covariance.h"

namespace vsgraphs {

namespace {

PoseGraph pose_graph_of(const Map& map, const KeyframeGraph& graph) {
  PoseGraph poses;
  for (const KeyframeId id : graph.keyframes) {
    poses.poses.push_back(map.keyframes().find(id)->world_from_camera);
    poses.pose_fixed.push_back(poses.poses.size() == 1);
  }
  for (const KeyframeEdge& edge : graph.edges)
    poses.edges.push_back({edge.a, edge.b, edge.a_from_b, information_of(edge.covariance), 0});
  return poses;
}

// The alignment knows its place to fractions of a millimetre, if one believes that errors of features are independent.
Matrix6d sober(const Matrix6d& information) {
  return information_of(covariance_of(information) + isotropic_covariance(0.005, 0.002));
}

}  // namespace

Corrections spread_correction(const Map& map, const KeyframeGraph& graph, const LoopAlignment& loop,
                              KeyframeId place, const LoopCorrectionOptions& options, SolveReport& report) {
  Corrections corrections(map.keyframes().index_bound());
  PoseGraph poses = pose_graph_of(map, graph);
  const int a = graph.position_of(place), b = graph.position_of(loop.keyframe);
  const Se3 a_from_b = poses.poses[static_cast<std::size_t>(a)].inverse() * loop.world_from_camera;
  poses.edges.push_back({a, b, a_from_b, sober(loop.information), 0});
  const std::vector<Se3> before = poses.poses;
  report = optimise_pose_graph(poses, options.iterations);
  for (std::size_t i = 0; i < before.size(); ++i)
    corrections[graph.keyframes[i].index] = (poses.poses[i] * before[i].inverse()).normalized();
  return corrections;
}

void move_map(const Corrections& corrections, Draft& draft) {
  const Map before = draft.map();
  for (EditOperation& move : carry(before, corrections)) draft.record(std::move(move));
  if (auto nodes = Carry(before, corrections).structure_nodes()) draft.record(*std::move(nodes));
}

void join_sights(const LoopAlignment& loop, Draft& draft) {
  for (const auto& [feature, landmark] : loop.sights) {
    const LandmarkId there = draft.map().landmarks().resolve(landmark);
    const Keyframe& keyframe = *draft.map().keyframes().find(loop.keyframe);
    const LandmarkId here = keyframe.landmarks[static_cast<std::size_t>(feature)];
    if (!there.valid() || here == there) continue;
    if (here.valid()) {
      draft.record(MergeLandmark{here, there});
    } else {
      draft.record(AddObservation{there, {loop.keyframe, static_cast<std::uint16_t>(feature)}});
    }
  }
}

namespace {

struct SeenPlane {
  PlaneId id;
  std::vector<SightedPatch> patches;  // as seen from the keyframes asked for
};

std::vector<SeenPlane> planes_seen_from(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::vector<SeenPlane> seen;
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    SeenPlane s{id, {}};
    for (const PlaneObservation& o : plane.observations) {
      const SurfacePatch* patch = map.patch(o);
      if (!patch || std::find(keyframes.begin(), keyframes.end(), o.keyframe) == keyframes.end()) continue;
      const Se3& world_from_camera = map.keyframes().find(o.keyframe)->world_from_camera;
      SightedPatch& placed = s.patches.emplace_back();
      // The plane as mapped, where the patch saw it: one reading of it may be poor.
      placed.plane = plane.plane;
      placed.area_m2 = static_cast<double>(patch->area_m2);
      for (const Eigen::Vector3f& p : patch->points)
        placed.points.push_back(plane.plane.project(world_from_camera * p.cast<double>()));
    }
    if (!s.patches.empty()) seen.push_back(std::move(s));
  });
  return seen;
}

bool coincide_anywhere(const SeenPlane& a, const SeenPlane& b, const LoopCheckOptions& options) {
  for (const SightedPatch& p : a.patches) {
    for (const SightedPatch& q : b.patches) {
      if (coincide(p, q, options) || coincide(q, p, options)) return true;
    }
  }
  return false;
}

}  // namespace

void merge_coinciding_planes(const std::vector<KeyframeId>& here, const std::vector<KeyframeId>& there,
                             const LoopCheckOptions& options, Draft& draft) {
  const std::vector<SeenPlane> ours = planes_seen_from(draft.map(), here);
  const std::vector<SeenPlane> theirs = planes_seen_from(draft.map(), there);
  for (const SeenPlane& a : ours) {
    for (const SeenPlane& b : theirs) {
      const PlaneId from = draft.map().planes().resolve(a.id), into = draft.map().planes().resolve(b.id);
      if (from == into || !coincide_anywhere(a, b, options)) continue;
      draft.record(MergePlane{std::max(from, into), std::min(from, into)});
    }
  }
}

}  // namespace vsgraphs
