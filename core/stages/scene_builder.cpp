#include "core/stages/scene_builder.h"

#include <algorithm>
#include <cmath>

#include "core/scene/up_direction.h"

namespace vsgraphs {

MapEdit SceneBuilder::propose(KeyframeId keyframe, const Snapshot& snapshot, const LabelGrid* labels,
                              TraceSink* trace) {
  Draft draft(snapshot);
  const Keyframe* now = draft.map().keyframes().find(keyframe);
  if (!now || !now->surface) return draft.take();
  recall(draft.map());
  std::vector<PlaneId> touched = associate(keyframe, labels, draft, trace);
  const Span span(trace, "interpret_planes");
  if (merges_all_) {
    touched.clear();
    draft.map().planes().for_each([&](PlaneId id, const MappedPlane&) { touched.push_back(id); });
    merges_all_ = false;
  }
  merge(touched, draft);
  const bool had_up = draft.map().up_in_world().has_value();
  find_up_direction(draft);
  if (!draft.map().up_in_world()) return draft.take();
  if (had_up) {
    gather_evidence(keyframe, draft.map());
  } else {  // in retrospect
    draft.map().keyframes().for_each(
        [&](KeyframeId id, const Keyframe&) { gather_evidence(id, draft.map()); });
  }
  touched.clear();
  draft.map().planes().for_each([&](PlaneId id, const MappedPlane&) { touched.push_back(id); });
  classify(touched, draft);
  pair_faces(touched, draft);
  remove_hidden_landmarks(keyframe, draft);
  return draft.take();
}

std::vector<PlaneId> SceneBuilder::associate(KeyframeId id, const LabelGrid* labels, Draft& draft,
                                             TraceSink* trace) {
  const Keyframe keyframe = *draft.map().keyframes().find(id);
  {
    const Span span(trace, "extract_planes");
    draft.record(SetPatches{id, std::make_shared<const KeyframeSurfaces>(extract_planes(
                                    *keyframe.surface, labels, camera_, options_.extraction))});
  }
  const Span span(trace, "associate_planes");
  const std::vector<SurfacePatch>& patches = draft.map().keyframes().find(id)->patches->patches;
  std::vector<PlacedPatch> placed;
  placed.reserve(patches.size());
  for (const SurfacePatch& patch : patches) placed.push_back(place(patch, keyframe.world_from_camera));
  std::vector<PlaneId> planes = associate_patches(draft.map(), placed, options_.association);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (!planes[i].valid()) {
      if (static_cast<double>(patches[i].area_m2) < options_.min_new_plane_area_m2) continue;
      MappedPlane plane;
      plane.plane = placed[i].plane;
      planes[i] = draft.add(std::move(plane));
    }
    draft.record(AddPlaneObservation{planes[i], {id, static_cast<std::uint16_t>(i)}});
  }
  planes.erase(std::remove_if(planes.begin(), planes.end(), [](PlaneId p) { return !p.valid(); }),
               planes.end());
  std::sort(planes.begin(), planes.end());
  planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  return planes;
}

void SceneBuilder::merge(const std::vector<PlaneId>& touched, Draft& draft) {
  for (const PlaneMerge& m : find_merges(draft.map(), touched, options_.association)) {
    draft.record(MergePlane{m.gone, m.kept});
    note_merge(m.gone, m.kept);
  }
}

void SceneBuilder::note_merge(PlaneId gone_id, PlaneId kept_id) {
  const auto gone = evidence_.find(gone_id);
  const auto kept = evidence_.find(kept_id);
  if (gone != evidence_.end() && kept != evidence_.end()) kept->second.add(gone->second);
  evidence_.erase(gone_id);
}

void SceneBuilder::recall(const Map& map) {
  if (!map.up_in_world()) return;
  bool known = map.planes().size() == 0;
  map.planes().for_each([&](PlaneId id, const MappedPlane&) { known |= evidence_.contains(id); });
  if (known) return;
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { gather_evidence(id, map); });
}

void SceneBuilder::move(const Map& map, const Se3& change) {
  map.planes().for_each([&](PlaneId id, const MappedPlane&) {
    const auto at = evidence_.find(id);
    if (at != evidence_.end()) at->second.move(change);
  });
  merges_all_ = true;
}

void SceneBuilder::find_up_direction(Draft& draft) const {
  const Map& map = draft.map();
  Eigen::Vector3d image_up = Eigen::Vector3d::Zero();
  map.keyframes().for_each(
      [&](KeyframeId, const Keyframe& k) { image_up -= k.world_from_camera.rotation().col(1); });
  image_up.normalize();
  std::vector<UprightEvidence> surfaces;
  map.planes().for_each([&](PlaneId, const MappedPlane& plane) {
    UprightEvidence evidence;
    evidence.normal = plane.plane.normal;
    evidence.below_the_camera = evidence.normal.dot(image_up) > 0;
    for (const PlaneObservation& o : plane.observations) {
      evidence.area_m2 = std::max(evidence.area_m2, static_cast<double>(map.patch(o)->area_m2));
    }
    surfaces.push_back(evidence);
  });
  const auto up = find_up(std::move(surfaces), image_up);
  if (up && (!map.up_in_world() || up->cross(*map.up_in_world()).norm() > 1e-3)) draft.record(SetUp{*up});
}

namespace {

// Where a plane was seen, by keyframes that live or are retired; world.
std::vector<Eigen::Vector3d> seen_points(const Map& map, const MappedPlane& plane) {
  std::vector<Eigen::Vector3d> points;
  for (const PlaneObservation& o : plane.observations) {
    const Se3 world_from_camera = *map.resolve({o.keyframe, Se3{}});
    for (const Eigen::Vector3f& p : map.patch(o)->points)
      points.push_back(world_from_camera * p.cast<double>());
  }
  return points;
}

}  // namespace

void SceneBuilder::gather_evidence(KeyframeId keyframe, const Map& map) {
  const Keyframe& seen = *map.keyframes().find(keyframe);
  if (!seen.surface) return;
  // A keyframe looked at again, for its labels, has told the planes it saw before all it can.
  const bool again = !told_.insert(keyframe).second;
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    auto [at, fresh] = evidence_.try_emplace(id, frame_of(plane.plane, map.up_in_world()));
    if (again && !fresh) return;
    if (fresh) at->second.expect(seen_points(map, plane));
    const bool observes_it =
        std::any_of(plane.observations.begin(), plane.observations.end(),
                    [keyframe](const PlaneObservation& o) { return o.keyframe == keyframe; });
    at->second.integrate(plane.plane, *seen.surface, seen.world_from_camera, camera_.depth_noise,
                         observes_it);
  });
}

SurfaceFacts SceneBuilder::facts_of(const Map& map, const MappedPlane& plane) const {
  SurfaceFacts facts;
  const Eigen::Vector3d& up = *map.up_in_world();
  facts.normal = plane.plane.normal;
  KeyframeId last;
  for (const PlaneObservation& o : plane.observations) {
    if (o.keyframe == last) continue;
    last = o.keyframe;
    ++facts.observations;
    facts.camera_height_m += up.dot(map.resolve({o.keyframe, Se3{}})->translation());
  }
  facts.camera_height_m /= std::max(1, facts.observations);
  facts.height_m = up.dot(plane.plane.project(plane.plane.anchor));
  constexpr double lowest_camera_m = 0.3;
  map.planes().for_each([&](PlaneId, const MappedPlane& other) {
    if (other.role != SurfaceRole::ground) return;
    const double height = up.dot(other.plane.project(other.plane.anchor));
    facts.lowest_level_m = std::min(height, facts.lowest_level_m.value_or(height));
    if (height < facts.camera_height_m - lowest_camera_m)
      facts.ground_height_m = std::max(height, facts.ground_height_m.value_or(height));
  });
  return facts;
}

bool SceneBuilder::another_is_the_wall(const Map& map, PlaneId id) const {
  const JudgedSurface surface{map.planes().find(id)->plane, evidence_.at(id)};
  bool found = false;
  map.planes().for_each([&](PlaneId other_id, const MappedPlane& other) {
    const auto at = evidence_.find(other_id);
    if (found || other_id == id || at == evidence_.end()) return;
    found = larger_is_the_wall(surface, {other.plane, at->second}, options_.association.max_angle_rad);
  });
  return found;
}

// One vote of each keyframe that saw the plane, shared among its patches by area: a segmenter splits a wall at its posters,
// and many small ones do not outvote the wall.
RoleVotes SceneBuilder::segmenter_votes(const Map& map, const MappedPlane& plane) {
  std::map<KeyframeId, float> seen_m2;
  for (const PlaneObservation& o : plane.observations) seen_m2[o.keyframe] += map.patch(o)->area_m2;
  RoleVotes votes{};
  for (const PlaneObservation& o : plane.observations) {
    const SurfacePatch& patch = *map.patch(o);
    const float all = seen_m2.at(o.keyframe);
    const float share = all > 0 ? patch.area_m2 / all : 0;
    for (std::size_t r = 0; r < surface_role_count; ++r) votes[r] += share * patch.votes[r];
  }
  return votes;
}

void SceneBuilder::classify(const std::vector<PlaneId>& candidates, Draft& draft) const {
  const Eigen::Vector3d up = *draft.map().up_in_world();
  // Level surfaces first: walls are measured from the ground.
  std::vector<PlaneId> order = candidates;
  std::stable_partition(order.begin(), order.end(), [&](PlaneId id) {
    return std::abs(draft.map().planes().find(id)->plane.normal.dot(up)) > 0.5;
  });
  for (const PlaneId id : order) {
    const MappedPlane& plane = *draft.map().planes().find(id);
    const auto evidence = evidence_.find(id);
    // Nobody alive sees a plane that was loaded: it stays what it was.
    if (evidence == evidence_.end() || evidence->second.unseen()) continue;
    RoleVotes votes = segmenter_votes(draft.map(), plane);
    SurfaceRole geometric =
        role_by_geometry(facts_of(draft.map(), plane), evidence->second, up, options_.role);
    const bool called_wall = geometric == SurfaceRole::wall ||
                             (geometric == SurfaceRole::undecided &&
                              votes[static_cast<std::size_t>(SurfaceRole::wall)] >= options_.accepted_votes);
    if (called_wall && another_is_the_wall(draft.map(), id)) geometric = SurfaceRole::other;
    if (geometric != SurfaceRole::undecided)
      votes[static_cast<std::size_t>(geometric)] += static_cast<float>(options_.geometry_votes);
    SurfaceRole role = SurfaceRole::undecided;
    auto most = static_cast<float>(options_.accepted_votes);
    for (std::size_t r = 1; r < surface_role_count; ++r) {
      const auto candidate = static_cast<SurfaceRole>(r);
      // Geometry says `other` of what it has seen to end in the air, or to hang on a wall: no network makes a wall of that.
      const bool excluded = geometric == SurfaceRole::other &&
                            (candidate == SurfaceRole::wall || candidate == SurfaceRole::ground);
      if (votes[r] < most || excluded ||
          !stance_allows(candidate, plane.plane.normal, up, options_.role.max_tilt_rad))
        continue;
      most = votes[r];
      role = candidate;
    }
    if (role != plane.role || votes != plane.votes) draft.record(ClassifyPlane{id, role, votes});
  }
}

void SceneBuilder::pair_faces(const std::vector<PlaneId>& touched, Draft& draft) const {
  for (const PlaneId id : touched) {
    const MappedPlane* plane = draft.map().planes().find(id);
    if (!plane) continue;
    const bool wall = plane->role == SurfaceRole::wall;
    if (!wall && plane->other_face.valid()) draft.record(PairFaces{id, {}, 0});
    if (!wall || plane->other_face.valid()) continue;
    if (const auto other = find_other_face(draft.map(), id, options_.association))
      draft.record(PairFaces{id, other->id, other->thickness_m});
  }
}

// A ray through a door or window crosses no solid cell.
void SceneBuilder::remove_hidden_landmarks(KeyframeId id, Draft& draft) const {
  const Keyframe keyframe = *draft.map().keyframes().find(id);
  const Eigen::Vector3d eye = keyframe.world_from_camera.translation();
  std::vector<LandmarkId> hidden;
  draft.map().planes().for_each([&](PlaneId plane_id, const MappedPlane& plane) {
    if (plane.role != SurfaceRole::wall && plane.role != SurfaceRole::ground) return;
    const auto evidence = evidence_.find(plane_id);
    const double from_eye = plane.plane.signed_distance(eye);
    if (evidence == evidence_.end() || from_eye <= 0) return;
    for (const LandmarkId landmark_id : keyframe.landmarks) {
      const Landmark* landmark = draft.map().landmarks().find(landmark_id);
      if (!landmark) continue;
      const double distance = plane.plane.signed_distance(landmark->point_in_world);
      const double sigma = camera_.depth_noise.sigma_m((landmark->point_in_world - eye).norm());
      if (distance > -(options_.max_behind_m + 3 * sigma)) continue;
      const Eigen::Vector3d crossing =
          eye + (landmark->point_in_world - eye) * (from_eye / (from_eye - distance));
      if (evidence->second.solid_at(crossing)) hidden.push_back(landmark_id);
    }
  });
  for (const LandmarkId landmark : hidden) draft.record(RemoveLandmark{landmark});
}

}  // namespace vsgraphs
