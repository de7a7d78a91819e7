#include "core/understanding/scene_builder.h"

#include <algorithm>
#include <cmath>

#include "core/scene/surfaces/up_direction.h"

namespace vsgraphs {

MapEdit SceneBuilder::associate(KeyframeId id, const Snapshot& snapshot, const SurfaceKeeper& surfaces,
                                const LabelGrid* labels, TraceSink* trace) const {
  Draft draft(snapshot);
  const Keyframe* found = draft.map().keyframes().find(id);
  if (!found || !found->surface) return draft.take();
  const Keyframe keyframe = *found;
  {
    const Span span(trace, "extract_planes");
    draft.record(SetPatches{id, std::make_shared<const KeyframeSurfaces>(extract_planes(
                                    *keyframe.surface, labels, camera_, options_.extraction))});
  }
  if (labels) keep_classes(id, *labels, draft);
  const Span span(trace, "associate_planes");
  const std::vector<SurfacePatch>& patches = draft.map().keyframes().find(id)->patches->patches;
  std::vector<PlacedPatch> placed;
  placed.reserve(patches.size());
  for (const SurfacePatch& patch : patches) placed.push_back(place(patch, keyframe.world_from_camera));
  std::vector<PlaneId> planes = associate_patches(draft.map(), surfaces, placed, options_.association);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (!planes[i].valid()) {
      if (static_cast<double>(patches[i].area_m2) < options_.min_new_plane_area_m2) continue;
      MappedPlane plane;
      plane.plane = placed[i].plane;
      planes[i] = draft.add(std::move(plane));
    }
    draft.record(AddPlaneObservation{planes[i], {id, static_cast<std::uint16_t>(i)}});
  }
  find_up_direction(surfaces, draft);
  return draft.take();
}

// What has a class and lies on no plane is kept too: nothing decides yet what becomes of it.
void SceneBuilder::keep_classes(KeyframeId id, const LabelGrid& labels, Draft& draft) {
  ClassNames fresh;
  for (const auto& [number, name] : labels.class_names)
    if (!draft.map().class_names().contains(number)) fresh.emplace(number, name);
  if (!fresh.empty()) draft.record(NameClasses{std::move(fresh)});
  auto classes = classes_of(labels);
  if (classes || draft.map().keyframes().find(id)->classes) draft.record(SetClasses{id, std::move(classes)});
}

// Before planes are merged, of which the surfaces learn with the edit; whichever way is up, or while nobody knows.
void SceneBuilder::call_planes(const SurfaceKeeper& surfaces, Draft& draft) {
  for (const PlaneId id : surfaces.changed()) {
    const KnownSurface* known = surfaces.find(id);
    const MappedPlane* plane = draft.map().planes().find(id);
    if (known && plane && known->class_votes() != plane->class_votes)
      draft.record(SetPlaneClasses{id, known->class_votes()});
  }
}

MapEdit SceneBuilder::interpret(KeyframeId keyframe, const Snapshot& snapshot, const SurfaceKeeper& surfaces,
                                TraceSink* trace) const {
  const Span span(trace, "interpret_planes");
  Draft draft(snapshot);
  call_planes(surfaces, draft);
  std::set<PlaneId> touched = surfaces.seen_by(keyframe);
  touched.insert(surfaces.moved().begin(), surfaces.moved().end());
  for (const PlaneMerge& m : find_merges(draft.map(), surfaces, touched, options_.association))
    draft.record(MergePlane{m.gone, m.kept});
  if (!draft.map().up_in_world()) return draft.take();
  // A level surface says something of others by what it is, and nothing more by growing: the ground lies beside all walls.
  const auto [level, upright] = by_stance(surfaces.changed(), draft.map());
  std::set<PlaneId> telling = classify(level, surfaces, draft);
  telling.insert(upright.begin(), upright.end());
  const std::vector<PlaneId> others = around(telling, surfaces, draft.map());
  classify(others, surfaces, draft);
  pair_faces(others, surfaces, draft);
  if (draft.map().keyframes().contains(keyframe)) remove_hidden_landmarks(keyframe, surfaces, draft);
  return draft.take();
}

void SceneBuilder::find_up_direction(const SurfaceKeeper& surfaces, Draft& draft) const {
  const Map& map = draft.map();
  Eigen::Vector3d image_up = Eigen::Vector3d::Zero();
  map.keyframes().for_each(
      [&](KeyframeId, const Keyframe& k) { image_up -= k.world_from_camera.rotation().col(1); });
  image_up.normalize();
  std::vector<UprightEvidence> found;
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    UprightEvidence evidence;
    evidence.normal = plane.plane.normal;
    evidence.below_the_camera = evidence.normal.dot(image_up) > 0;
    const KnownSurface* known = surfaces.find(id);
    if (known) evidence.area_m2 = known->largest_patch_m2();
    // What the newest keyframe saw stands at the end, and is not known yet.
    if (!plane.observations.empty())
      evidence.area_m2 =
          std::max(evidence.area_m2, static_cast<double>(map.patch(plane.observations.back())->area_m2));
    found.push_back(evidence);
  });
  const auto up = find_up(std::move(found), image_up);
  if (up && (!map.up_in_world() || up->cross(*map.up_in_world()).norm() > 1e-3)) draft.record(SetUp{*up});
}

SceneBuilder::Stances SceneBuilder::by_stance(const std::set<PlaneId>& planes, const Map& map) {
  Stances stances;
  for (const PlaneId id : planes) {
    const MappedPlane* plane = map.planes().find(id);
    if (!plane) continue;
    const bool level = std::abs(plane->plane.normal.dot(*map.up_in_world())) > 0.5;
    (level ? stances.level : stances.upright).push_back(id);
  }
  return stances;
}

// What is known of a plane says something of those beside it, too: what hangs on a wall, and whether it stands on the ground.
std::vector<PlaneId> SceneBuilder::around(const std::set<PlaneId>& changed, const SurfaceKeeper& surfaces,
                                          const Map& map) {
  constexpr double beside_m = 1.0;
  std::vector<PlaneId> found;
  map.planes().for_each([&](PlaneId id, const MappedPlane&) {
    const KnownSurface* known = surfaces.find(id);
    if (!known) return;
    const bool near = std::any_of(changed.begin(), changed.end(), [&](PlaneId other_id) {
      const KnownSurface* other = surfaces.find(other_id);
      return other_id == id || (other && (other->centre() - known->centre()).norm() <
                                             other->radius_m() + known->radius_m() + beside_m);
    });
    if (near) found.push_back(id);
  });
  return found;
}

SurfaceFacts SceneBuilder::facts_of(const Map& map, const MappedPlane& plane, const KnownSurface& known,
                                    const StretchPoses& stretches) {
  SurfaceFacts facts;
  const Eigen::Vector3d& up = *map.up_in_world();
  facts.normal = plane.plane.normal;
  facts.observations = known.keyframes();
  facts.camera_height_m = up.dot(known.mean_camera(stretches));
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

bool SceneBuilder::another_is_the_wall(const Map& map, const SurfaceKeeper& surfaces, PlaneId id) const {
  const KnownSurface& known = *surfaces.find(id);
  const JudgedSurface surface{map.planes().find(id)->plane, known.evidence()};
  bool found = false;
  map.planes().for_each([&](PlaneId other_id, const MappedPlane& other) {
    const KnownSurface* theirs = surfaces.find(other_id);
    if (found || other_id == id || !theirs) return;
    constexpr double beside_m = 1.0;
    if ((theirs->centre() - known.centre()).norm() > theirs->radius_m() + known.radius_m() + beside_m) return;
    found =
        larger_is_the_wall(surface, {other.plane, theirs->evidence()}, options_.association.max_angle_rad);
  });
  return found;
}

// The role the votes and geometry agree on, and the votes with geometry's among them.
SurfaceRole SceneBuilder::judge(const Map& map, const SurfaceKeeper& surfaces, PlaneId id,
                                RoleVotes& votes) const {
  const Eigen::Vector3d& up = *map.up_in_world();
  const MappedPlane& plane = *map.planes().find(id);
  const KnownSurface& known = *surfaces.find(id);
  SurfaceRole geometric = role_by_geometry(facts_of(map, plane, known, surfaces.stretches()),
                                           known.evidence(), up, options_.role);
  const bool called_wall = geometric == SurfaceRole::wall ||
                           (geometric == SurfaceRole::undecided &&
                            votes[static_cast<std::size_t>(SurfaceRole::wall)] >= options_.accepted_votes);
  if (called_wall && another_is_the_wall(map, surfaces, id)) geometric = SurfaceRole::other;
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
  return role;
}

std::set<PlaneId> SceneBuilder::classify(const std::vector<PlaneId>& planes, const SurfaceKeeper& surfaces,
                                         Draft& draft) const {
  std::set<PlaneId> changed;
  for (const PlaneId id : planes) {
    const KnownSurface* known = surfaces.find(id);
    // Nobody alive sees a plane that was loaded: it stays what it was.
    if (!known || known->evidence().unseen()) continue;
    RoleVotes votes = known->votes();
    const SurfaceRole role = judge(draft.map(), surfaces, id, votes);
    const MappedPlane& plane = *draft.map().planes().find(id);
    if (role != plane.role) changed.insert(id);
    if (role != plane.role || votes != plane.votes) draft.record(ClassifyPlane{id, role, votes});
  }
  return changed;
}

void SceneBuilder::pair_faces(const std::vector<PlaneId>& candidates, const SurfaceKeeper& surfaces,
                              Draft& draft) const {
  for (const PlaneId id : candidates) {
    const MappedPlane* plane = draft.map().planes().find(id);
    if (!plane) continue;
    const bool wall = plane->role == SurfaceRole::wall;
    if (!wall && plane->other_face.valid()) draft.record(PairFaces{id, {}, 0});
    if (!wall || plane->other_face.valid()) continue;
    if (const auto other = find_other_face(draft.map(), surfaces, id, options_.association))
      draft.record(PairFaces{id, other->id, other->thickness_m});
  }
}

// A ray through a door or window crosses no solid cell.
void SceneBuilder::remove_hidden_landmarks(KeyframeId id, const SurfaceKeeper& surfaces, Draft& draft) const {
  const Keyframe keyframe = *draft.map().keyframes().find(id);
  const Eigen::Vector3d eye = keyframe.world_from_camera.translation();
  std::vector<LandmarkId> hidden;
  draft.map().planes().for_each([&](PlaneId plane_id, const MappedPlane& plane) {
    if (plane.role != SurfaceRole::wall && plane.role != SurfaceRole::ground) return;
    const KnownSurface* known = surfaces.find(plane_id);
    const double from_eye = plane.plane.signed_distance(eye);
    if (!known || from_eye <= 0) return;
    for (const LandmarkId landmark_id : keyframe.landmarks) {
      const Landmark* landmark = draft.map().landmarks().find(landmark_id);
      if (!landmark) continue;
      const double distance = plane.plane.signed_distance(landmark->point_in_world);
      const double sigma = camera_.depth_noise.sigma_m((landmark->point_in_world - eye).norm());
      if (distance > -(options_.max_behind_m + 3 * sigma)) continue;
      const Eigen::Vector3d crossing =
          eye + (landmark->point_in_world - eye) * (from_eye / (from_eye - distance));
      if (known->evidence().solid_at(crossing)) hidden.push_back(landmark_id);
    }
  });
  for (const LandmarkId landmark : hidden) draft.record(RemoveLandmark{landmark});
}

}  // namespace vsgraphs
