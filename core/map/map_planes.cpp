// The part of the map that deals with planes.
#include <algorithm>

#include "core/map/map.h"

namespace vsgraphs {

const char* to_string(SurfaceRole role) {
  static constexpr const char* names[surface_role_count] = {"undecided", "wall",   "ground", "ceiling",
                                                            "door",      "window", "other"};
  return names[static_cast<std::size_t>(role)];
}

const SurfacePatch* Map::patch(const PlaneObservation& observation) const {
  const KeyframeSurfaces* surfaces = nullptr;
  if (const Keyframe* keyframe = keyframes_.find(observation.keyframe)) {
    surfaces = keyframe->patches.get();
  } else if (const RetiredKeyframe* retired = retired_.find(observation.keyframe)) {
    surfaces = retired->patches.get();
  }
  return surfaces && observation.patch < surfaces->patches.size() ? &surfaces->patches[observation.patch]
                                                                  : nullptr;
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
  planes_.erase(op.id);
}

void Map::apply_one(const MergePlane& op) {
  const MappedPlane* from = planes_.find(op.id);
  if (!from || !planes_.contains(op.into) || op.id == op.into) return;
  const MappedPlane merged = *from;
  apply_one(PairFaces{op.id, {}, 0});
  planes_.erase(op.id, op.into);
  for (const PlaneObservation& observation : merged.observations) {
    apply_one(AddPlaneObservation{op.into, observation});
  }
  MappedPlane& into = *planes_.edit(op.into);
  for (std::size_t i = 0; i < surface_role_count; ++i) into.votes[i] += merged.votes[i];
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

void Map::apply_one(const SetUp& op) { up_in_world_ = op.up_in_world.normalized(); }

}  // namespace vsgraphs
