#include "core/scene/surfaces/surface_keeper.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/map/stretch.h"

namespace vsgraphs {

namespace {

// A keyframe that moved within its stretch by more is counted anew.
constexpr double moved_m = 0.03, turned_rad = 0.01;

bool deviates(const Se3& a, const Se3& b) {
  const Se3 change = a.inverse() * b;
  return change.translation().norm() > moved_m || rotation_angle(change.rotation()) > turned_rad;
}

bool looks_at_a_keyframe(const MapEdit& edit) {
  return std::any_of(edit.operations.begin(), edit.operations.end(), [](const EditOperation& op) {
    const auto* set = std::get_if<SetPatches>(&op);
    return set && set->patches;
  });
}

}  // namespace

std::set<PlaneId> SurfaceKeeper::seen_by(KeyframeId keyframe) const {
  std::set<PlaneId> planes;
  if (const auto told = told_.find(keyframe); told != told_.end()) {
    for (const Sight& sight : told->second.sights) planes.insert(sight.plane);
  }
  return planes;
}

const KnownSurface* SurfaceKeeper::find(PlaneId id) const {
  const auto at = known_.find(id);
  return at == known_.end() ? nullptr : &at->second;
}

// Goes through an edit's operations; what is no business of planes does nothing.
class SurfaceKeeper::Following {
 public:
  Following(SurfaceKeeper& keeper, const Map& after, const SurfaceKeeper* absorbed)
      : keeper_(keeper), after_(after), absorbed_(absorbed) {}

  void run(const MapEdit& edit) {
    for (const EditOperation& operation : edit.operations)
      std::visit([this](const auto& op) { say(op); }, operation);
    if (!keeper_.shifted_.empty()) keeper_.follow_keyframes(after_);
    std::erase_if(keeper_.known_,
                  [this](const auto& entry) { return !after_.planes().contains(entry.first); });
    keeper_.settle_touched(after_);
    for (const KeyframeId id : looking_) keeper_.tell_rays(after_, id);
  }

 private:
  template <typename Other>
  void say(const Other&) {}
  void say(const SetPatches& op) {
    keeper_.take_back_patches(after_, op.id);
    if (op.patches) looking_.insert(op.id);
  }
  void say(const AddPlaneObservation& op) { keeper_.tell(after_, op.plane, op.observation); }
  void say(const RemovePlaneObservation& op) { keeper_.take_back(after_, op.plane, op.observation); }
  void say(const RemovePlane& op) { keeper_.forget(after_, op.id); }
  void say(const MergePlane& op) { keeper_.merge(after_, op.id, after_.planes().resolve(op.into)); }
  void say(const RemoveKeyframe& op) { keeper_.let_go(after_, op.id); }
  void say(const MoveKeyframe& op) { keeper_.shifted_.insert(after_.stretch_of(op.id)); }
  void say(const AbsorbMap& op) {
    keeper_.absorb(after_, *absorbed_);
    op.other->keyframes().for_each([this](KeyframeId id, const Keyframe& keyframe) {
      if (keyframe.patches && !keeper_.told_[id].rays)
        looking_.insert(id);  // that map did not know which way is up
    });
  }

  SurfaceKeeper& keeper_;
  const Map& after_;
  const SurfaceKeeper* absorbed_;
  std::set<KeyframeId> looking_;
};

void SurfaceKeeper::follow(const Map&, const MapEdit& edit, const Map& after, const Follower* absorbed) {
  const auto* other = dynamic_cast<const SurfaceKeeper*>(absorbed);
  const auto is_absorb = [](const EditOperation& op) { return std::holds_alternative<AbsorbMap>(op); };
  const bool absorbs = std::any_of(edit.operations.begin(), edit.operations.end(), is_absorb);
  if (std::exchange(to_interpret_, looks_at_a_keyframe(edit))) {
    changed_.clear();
    moved_.clear();
  }
  if ((after.up_in_world() && !up_) || (absorbs && !other)) {
    gather(after);
    if (absorbs) moved_ = changed_;
    return;
  }
  for (const EditOperation& operation : edit.operations) {
    if (const auto* added = std::get_if<AddKeyframe>(&operation)) open_stretch(after, added->id);
  }
  settle(after);
  Following(*this, after, other).run(edit);
}

void SurfaceKeeper::gather(const Map& map) {
  const bool to_interpret = to_interpret_;
  *this = SurfaceKeeper(noise_);
  to_interpret_ = to_interpret;
  up_ = map.up_in_world();
  const auto& all = map.retired_keyframes();
  for (std::uint32_t index = 0; index < all.index_bound(); ++index)
    if (all.at_index(index).valid()) open_stretch(map, all.at_index(index));
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) {
    for (const PlaneObservation& o : plane.observations) tell(map, id, o);
  });
  settle_touched(map);
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { tell_rays(map, id); });
}

void SurfaceKeeper::open_stretch(const Map& map, KeyframeId id) {
  if (map.stretch_of(id) == id) stretches_[id] = *world_from_stretch(map, id);
}

// Where the stretches stand, and what that does to the planes seen from those that moved.
void SurfaceKeeper::settle(const Map& map) {
  shifted_.clear();
  for (auto& [stretch, pose] : stretches_) {
    const Se3 now = *world_from_stretch(map, stretch);
    if (now.matrix() != pose.matrix()) shifted_.insert(stretch);
    pose = now;
  }
  if (shifted_.empty()) return;
  for (auto& [id, known] : known_) {
    const bool touched = std::any_of(known.pieces().begin(), known.pieces().end(),
                                     [&](const auto& piece) { return shifted_.contains(piece.first); });
    if (!touched || !known.settle(stretches_)) continue;
    moved_.insert(id);
    changed_.insert(id);
  }
}

SurfaceVotes SurfaceKeeper::votes_of(const Told& told, PlaneId plane) const {
  float all = 0;
  for (const Sight& s : told.sights) all += s.plane == plane ? told.patches->patches[s.patch].area_m2 : 0;
  SurfaceVotes votes;
  for (const Sight& s : told.sights) {
    if (s.plane != plane || !(all > 0)) continue;
    const SurfacePatch& patch = told.patches->patches[s.patch];
    const float share = patch.area_m2 / all;
    for (std::size_t r = 0; r < surface_role_count; ++r) votes.roles[r] += share * patch.votes[r];
    add_votes(votes.classes, patch.class_votes, share);
  }
  return votes;
}

bool SurfaceKeeper::sees(const Told& told, PlaneId plane) {
  return std::any_of(told.sights.begin(), told.sights.end(),
                     [plane](const Sight& s) { return s.plane == plane; });
}

// Has a keyframe see more or less of a plane: one vote of each keyframe, shared among its patches by area, since a segmenter
// splits a wall at its posters, and many small ones do not outvote the wall.
template <typename Change>
void SurfaceKeeper::change_sights(const Map& map, PlaneId plane, KeyframeId keyframe, const Change& change) {
  KnownSurface& known = known_.at(plane);
  Told& told = told_.at(keyframe);
  const KeyframeId stretch = map.stretch_of(keyframe);
  const bool saw = sees(told, plane);
  known.count_votes(votes_of(told, plane), -1);
  change(known, told, stretch);
  touched_.insert(plane);
  known.count_votes(votes_of(told, plane), 1);
  if (const bool now = sees(told, plane); now != saw)
    known.count_keyframe(stretch, told.stretch_from_camera, now ? 1 : -1);
  changed_.insert(plane);
}

void SurfaceKeeper::tell(const Map& map, PlaneId plane, const PlaneObservation& observation) {
  const SurfacePatch* patch = map.patch(observation);
  const MappedPlane* mapped = map.planes().find(plane);
  const auto pose = map.resolve({observation.keyframe, Se3{}});
  if (!patch || !mapped || !pose) return;
  const KeyframeId stretch = map.stretch_of(observation.keyframe);
  const auto at = told_.try_emplace(observation.keyframe).first;
  if (at->second.sights.empty()) {
    at->second.patches = map.patches_of(observation.keyframe);
    at->second.stretch_from_camera = stretches_.at(stretch).inverse() * *pose;
  }
  const Sight sight{plane, observation.patch};
  auto& sights = at->second.sights;
  if (std::find(sights.begin(), sights.end(), sight) != sights.end()) return;
  known_[plane].open_piece(stretch, stretches_, mapped->plane, up_);
  change_sights(map, plane, observation.keyframe, [&](KnownSurface& known, Told& told, KeyframeId) {
    told.sights.push_back(sight);
    known.count_patch(stretch, told.stretch_from_camera, *patch, stretches_, 1);
  });
}

void SurfaceKeeper::take_back(const Map& map, PlaneId plane, const PlaneObservation& observation) {
  const auto told = told_.find(observation.keyframe);
  const Sight sight{plane, observation.patch};
  if (told == told_.end() || !known_.contains(plane)) return;
  const auto found = std::find(told->second.sights.begin(), told->second.sights.end(), sight);
  if (found == told->second.sights.end()) return;
  change_sights(map, plane, observation.keyframe, [&](KnownSurface& known, Told& t, KeyframeId stretch) {
    const SurfacePatch& patch = t.patches->patches[sight.patch];
    t.sights.erase(found);
    known.count_patch(stretch, t.stretch_from_camera, patch, stretches_, -1);
  });
  let_go(map, observation.keyframe);
}

// Of a keyframe that sees no plane (any more) nothing is kept but that it has told what it can; of one that is gone, not even that.
void SurfaceKeeper::let_go(const Map& map, KeyframeId keyframe) {
  const auto told = told_.find(keyframe);
  if (told == told_.end() || !told->second.sights.empty()) return;
  told->second.patches = nullptr;
  if (!map.keyframes().contains(keyframe)) told_.erase(told);
}

// Once per edit, however much of a plane has changed.
void SurfaceKeeper::settle_touched(const Map& map) {
  for (const PlaneId id : std::exchange(touched_, {})) {
    const auto known = known_.find(id);
    if (known == known_.end()) continue;
    if (known->second.lost_patches()) find_largest_patch(map, id);
    known->second.settle(stretches_);
  }
}

void SurfaceKeeper::find_largest_patch(const Map& map, PlaneId plane) {
  double largest_m2 = 0;
  for (const PlaneObservation& o : map.planes().find(plane)->observations) {
    const SurfacePatch* patch = map.patch(o);
    largest_m2 = std::max(largest_m2, patch ? static_cast<double>(patch->area_m2) : 0);
  }
  known_.at(plane).set_largest_patch(largest_m2);
}

void SurfaceKeeper::take_back_patches(const Map& map, KeyframeId keyframe) {
  const auto told = told_.find(keyframe);
  if (told == told_.end()) return;
  const std::vector<Sight> sights = told->second.sights;
  for (const Sight& s : sights) take_back(map, s.plane, {keyframe, s.patch});
}

void SurfaceKeeper::merge(const Map& after, PlaneId gone, PlaneId into) {
  const auto from = known_.find(gone);
  if (from == known_.end() || gone == into) return;
  if (!into.valid()) return forget(after, gone);
  KnownSurface& known = known_[into];
  known.take_over(from->second, stretches_);
  for (auto& [keyframe, told] : told_)
    if (sees(told, gone)) see_as_one(known, told, after.stretch_of(keyframe), gone, into);
  known_.erase(gone);
  changed_.insert(into);
  touched_.insert(into);
}

// A keyframe that saw both has one vote, and stands at one place.
void SurfaceKeeper::see_as_one(KnownSurface& known, Told& told, KeyframeId stretch, PlaneId gone,
                               PlaneId into) {
  const bool saw_both = sees(told, into);
  for (const PlaneId id : {gone, into}) known.count_votes(votes_of(told, id), -1);
  for (Sight& s : told.sights) s.plane = s.plane == gone ? into : s.plane;
  known.count_votes(votes_of(told, into), 1);
  if (saw_both) known.count_keyframe(stretch, told.stretch_from_camera, -1);
}

void SurfaceKeeper::forget(const Map& map, PlaneId plane) {
  std::vector<KeyframeId> left;
  for (auto& [keyframe, told] : told_) {
    std::erase_if(told.sights, [plane](const Sight& s) { return s.plane == plane; });
    if (told.sights.empty()) left.push_back(keyframe);
  }
  for (const KeyframeId keyframe : left) let_go(map, keyframe);
  known_.erase(plane);
}

void SurfaceKeeper::absorb(const Map& map, const SurfaceKeeper& other) {
  known_.insert(other.known_.begin(), other.known_.end());
  told_.insert(other.told_.begin(), other.told_.end());
  for (const auto& [stretch, pose] : other.stretches_) open_stretch(map, stretch);
  for (auto& [id, known] : known_) {
    known.settle(stretches_);
    moved_.insert(id);
    changed_.insert(id);
  }
}

// Those that moved within their stretch: what they saw is counted where they stand now. Their rays stay as they were counted.
void SurfaceKeeper::follow_keyframes(const Map& map) {
  std::vector<KeyframeId> moved;
  for (const auto& [id, told] : told_) {
    const KeyframeId stretch = map.stretch_of(id);
    if (!told.sights.empty() && shifted_.contains(stretch) &&
        deviates(told.stretch_from_camera, stretches_.at(stretch).inverse() * *map.resolve({id, Se3{}})))
      moved.push_back(id);
  }
  for (const KeyframeId id : moved) {
    Told& told = told_.at(id);
    const std::vector<Sight> sights = told.sights;
    for (const Sight& s : sights) take_back(map, s.plane, {id, s.patch});
    for (const Sight& s : sights) tell(map, s.plane, {id, s.patch});
  }
}

// A keyframe looked at again, for its labels, has told the planes it saw before all it can.
void SurfaceKeeper::tell_rays(const Map& map, KeyframeId id) {
  const Keyframe* keyframe = map.keyframes().find(id);
  if (!keyframe || !keyframe->surface || !up_) return;
  Told& told = told_[id];
  const bool again = std::exchange(told.rays, true);
  const Eigen::Vector3d camera = keyframe->world_from_camera.translation();
  for (auto& [plane, known] : known_) {
    const bool observes_it = sees(told, plane);
    const bool near = (known.centre() - camera).norm() < known.radius_m() + PlaneEvidence::max_range_m;
    if ((!near && !observes_it) || (again && !known.evidence().unseen())) continue;
    const MetRays rays = rays_that_meet(map.planes().find(plane)->plane, *keyframe->surface,
                                        keyframe->world_from_camera, noise_);
    if (rays.on.empty() && rays.through.empty()) continue;
    known.open_piece(keyframe->stretch, stretches_, map.planes().find(plane)->plane, up_);
    known.count_rays(keyframe->stretch, rays, stretches_, observes_it);
    changed_.insert(plane);
  }
}

}  // namespace vsgraphs
