// The part of the map that deals with planes.
#include <algorithm>

#include "core/map/map.h"

namespace vsgraphs {

const char* to_string(SurfaceRole role) {
  static constexpr const char* names[surface_role_count] = {"undecided", "wall",   "ground", "ceiling",
                                                            "door",      "window", "other"};
  return names[static_cast<std::size_t>(role)];
}

const std::shared_ptr<const KeyframeSurfaces>& Map::patches_of(KeyframeId id) const {
  static const std::shared_ptr<const KeyframeSurfaces> none;
  const Keyframe* living = keyframes_.find(id);
  const RetiredKeyframe* retired = retired_.find(id);
  return living ? living->patches : retired ? retired->patches : none;
}

const SurfacePatch* Map::patch(const PlaneObservation& observation) const {
  const KeyframeSurfaces* surfaces = patches_of(observation.keyframe).get();
  return surfaces && observation.patch < surfaces->patches.size() ? &surfaces->patches[observation.patch]
                                                                  : nullptr;
}

Eigen::Vector3d Map::observed_centre(const MappedPlane& plane) const {
  constexpr std::size_t enough = 256;
  const std::size_t step = 1 + plane.observations.size() / enough;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < plane.observations.size(); i += step) {
    const PlaneObservation& observation = plane.observations[i];
    const SurfacePatch* seen = patch(observation);
    const auto pose = resolve({observation.keyframe, Se3{}});
    if (!seen || !pose) continue;
    sum += *pose * seen->plane.anchor;
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : plane.plane.anchor;
}

void Map::apply_one(const SetPatches& op) {
  Keyframe* keyframe = keyframes_.edit(op.id);
  if (!keyframe) return;
  if (keyframe->patches) {
    std::vector<std::pair<PlaneId, PlaneObservation>> old;
    planes_.for_each([&](PlaneId id, const MappedPlane& plane) {
      for (const PlaneObservation& o : plane.observations) {
        if (o.keyframe == op.id) old.emplace_back(id, o);
      }
    });
    for (const auto& [plane, observation] : old) apply_one(RemovePlaneObservation{plane, observation});
  }
  keyframe->patches = op.patches;
}

void Map::apply_one(const AddPlane& op) { planes_.insert_at(op.id, op.plane); }

void Map::apply_one(const RemovePlane& op) {
  apply_one(PairFaces{op.id, {}, 0});
  relink_structure(op.id, {});
  planes_.erase(op.id);
}

void Map::apply_one(const MergePlane& op) {
  const MappedPlane* from = planes_.find(op.id);
  if (!from || !planes_.contains(op.into) || op.id == op.into) return;
  const MappedPlane merged = *from;
  apply_one(PairFaces{op.id, {}, 0});
  planes_.erase(op.id, op.into);
  relink_structure(op.id, op.into);
  for (const PlaneObservation& observation : merged.observations) {
    apply_one(AddPlaneObservation{op.into, observation});
  }
  MappedPlane& into = *planes_.edit(op.into);
  for (std::size_t i = 0; i < surface_role_count; ++i) into.votes[i] += merged.votes[i];
  add_votes(into.class_votes, merged.class_votes, 1);
}

void Map::apply_one(const AddPlaneObservation& op) {
  const MappedPlane* plane = planes_.find(op.plane);
  if (!plane || !patch(op.observation)) return;
  const auto& observations = plane->observations;
  if (std::find(observations.begin(), observations.end(), op.observation) != observations.end()) return;
  planes_.edit(op.plane)->observations.push_back(op.observation);
}

void Map::apply_one(const RemovePlaneObservation& op) {
  if (!planes_.contains(op.plane)) return;
  auto& observations = planes_.edit(op.plane)->observations;
  observations.erase(std::remove(observations.begin(), observations.end(), op.observation),
                     observations.end());
  // Nothing holds it in place any longer.
  if (observations.empty()) apply_one(RemovePlane{op.plane});
}

void Map::apply_one(const MovePlane& op) {
  if (MappedPlane* plane = planes_.edit(op.id)) plane->plane = op.plane;
}

void Map::apply_one(const ClassifyPlane& op) {
  if (MappedPlane* plane = planes_.edit(op.id)) {
    plane->role = op.role;
    plane->votes = op.votes;
  }
}

void Map::apply_one(const NameClasses& op) {
  ClassNames names = *class_names_;
  names.insert(op.names.begin(), op.names.end());
  if (names.size() > class_names_->size())
    class_names_ = std::make_shared<const ClassNames>(std::move(names));
}

void Map::apply_one(const SetClasses& op) {
  if (Keyframe* keyframe = keyframes_.edit(op.id)) keyframe->classes = op.classes;
}

void Map::apply_one(const SetPlaneClasses& op) {
  if (MappedPlane* plane = planes_.edit(op.id)) plane->class_votes = op.votes;
}

void Map::apply_one(const PairFaces& op) {
  const auto part = [this](PlaneId id) {
    const MappedPlane* plane = planes_.find(id);
    if (!plane || !plane->other_face.valid()) return;
    if (MappedPlane* other = planes_.edit(plane->other_face)) {
      other->other_face = {};
      other->thickness_m = 0;
    }
    MappedPlane* self = planes_.edit(id);
    self->other_face = {};
    self->thickness_m = 0;
  };
  part(op.id);
  if (!planes_.contains(op.id) || !planes_.contains(op.other) || op.id == op.other) return;
  part(op.other);
  for (const auto& [id, other] : {std::pair{op.id, op.other}, std::pair{op.other, op.id}}) {
    MappedPlane* plane = planes_.edit(id);
    plane->other_face = other;
    plane->thickness_m = op.thickness_m;
  }
}

namespace {

bool uses(const FoundStructure& structure, PlaneId id) {
  const auto has = [id](const std::vector<PlaneId>& ids) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  };
  return std::any_of(structure.rooms.begin(), structure.rooms.end(),
                     [&](const FoundRoom& r) { return has(r.walls) || r.ground == id || r.ceiling == id; }) ||
         std::any_of(structure.floors.begin(), structure.floors.end(),
                     [&](const FoundFloor& f) { return has(f.grounds); }) ||
         std::any_of(structure.elements.begin(), structure.elements.end(),
                     [&](const FoundElement& e) { return has(e.planes); });
}

void relink(std::vector<PlaneId>& ids, PlaneId gone, PlaneId into) {
  std::replace(ids.begin(), ids.end(), gone, into);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  ids.erase(std::remove(ids.begin(), ids.end(), PlaneId{}), ids.end());
}

}  // namespace

void Map::relink_structure(PlaneId gone, PlaneId into) {
  if (!uses(*structure_, gone)) return;
  FoundStructure changed = *structure_;
  for (FoundRoom& room : changed.rooms) {
    relink(room.walls, gone, into);
    if (room.ground == gone) room.ground = into;
    if (room.ceiling == gone) room.ceiling = into;
  }
  for (FoundFloor& floor : changed.floors) relink(floor.grounds, gone, into);
  for (FoundElement& element : changed.elements) relink(element.planes, gone, into);
  structure_ = std::make_shared<const FoundStructure>(std::move(changed));
}

void Map::apply_one(const SetStructure& op) { structure_ = op.structure; }

void Map::apply_one(const MoveStructureNodes& op) {
  if (op.rooms.size() != structure_->room_nodes.size() || op.floors.size() != structure_->floor_nodes.size())
    return;
  FoundStructure changed = *structure_;
  changed.room_nodes = op.rooms;
  changed.floor_nodes = op.floors;
  structure_ = std::make_shared<const FoundStructure>(std::move(changed));
}

void Map::apply_one(const SetUp& op) { up_in_world_ = op.up_in_world.normalized(); }

}  // namespace vsgraphs
