#include "core/loops/loop_rebase.h"

#include <optional>
#include <vector>

#include "core/base/check.h"
#include "core/map/carry.h"

namespace vsgraphs {

namespace {

class Rebaser {
 public:
  Rebaser(const MapEdit& edit, const Map& old_map, const Map& now, const std::vector<Se3>& moved)
      : edit_(edit), old_(old_map), now_(now), moved_(moved) {
    edited_.resize(old_.keyframes().index_bound());
    for (const EditOperation& operation : edit.operations) {
      const auto* move = std::get_if<MoveKeyframe>(&operation);
      if (move && move->id.index < edited_.size()) edited_[move->id.index] = move->world_from_camera;
    }
    corrections_.resize(now_.keyframes().index_bound());
    now_.keyframes().for_each([this](KeyframeId id, const Keyframe& keyframe) {
      corrections_[id.index] = correction_of(id, keyframe);
    });
  }

  MapEdit run() {
    MapEdit out;
    out.based_on = now_.version();
    for (const EditOperation& operation : edit_.operations) {
      std::visit([this, &out](const auto& op) { say(op, out.operations); }, operation);
    }
    carry_new(out.operations);
    return out;
  }

 private:
  // What moves a living keyframe from where it is now to where it shall be, world from world.
  Se3 correction_of(KeyframeId id, const Keyframe& keyframe) const {
    if (old_.keyframes().contains(id)) {
      const auto& edited = edited_[id.index];
      if (!edited) return Se3{};
      const Se3 by_loops = id.index < moved_.size() ? moved_[id.index] : Se3{};
      return by_loops * *edited * keyframe.world_from_camera.inverse();
    }
    return corrections_[anchor_of_new(id, keyframe).index];
  }

  // Older ones have their corrections by then.
  KeyframeId anchor_of_new(KeyframeId id, const Keyframe& keyframe) const {
    if (keyframe.tracked_link) {
      const auto to = now_.reanchor({keyframe.tracked_link->to, Se3{}});
      if (to && to->keyframe < id) return to->keyframe;
    }
    for (const auto& [other, shared] : now_.covisible(id, 1)) {
      if (other < id) return other;
    }
    for (std::uint32_t index = id.index; index-- > 0;) {
      if (const KeyframeId other = now_.keyframes().at_index(index); other.valid()) return other;
    }
    return id;  // the first of all: its correction is still the identity
  }

  // From where the edit has a keyframe that observed something to where that keyframe ends up: the first one that lives in both
  // maps, else the first one at all, through its anchor.
  template <typename Observation>
  std::optional<Se3> way_of_first(const std::vector<Observation>& observations) const {
    for (const Observation& o : observations) {
      if (old_.keyframes().contains(o.keyframe) && now_.keyframes().contains(o.keyframe))
        return way_of(o.keyframe);
    }
    for (const Observation& o : observations) {
      if (const auto way = way_of(o.keyframe)) return way;
    }
    return std::nullopt;
  }

  std::optional<Se3> way_of(KeyframeId id) const {
    const auto in_old = old_.reanchor({id, Se3{}});
    const auto in_now = now_.reanchor({id, Se3{}});
    if (!in_old || !in_now) return std::nullopt;
    const auto& edited = edited_[in_old->keyframe.index];
    const Se3 there = edited ? *edited * in_old->keyframe_from_camera : *old_.resolve(*in_old);
    return corrections_[in_now->keyframe.index] * *now_.resolve(*in_now) * there.inverse();
  }

  void say(const AddKeyframe&, std::vector<EditOperation>&) { refuse(); }
  void say(const AddLandmark&, std::vector<EditOperation>&) { refuse(); }
  void say(const AddPlane&, std::vector<EditOperation>&) { refuse(); }
  void say(const AddMarker&, std::vector<EditOperation>&) { refuse(); }
  static void refuse() { throw InvariantError("an edit that adds to the map cannot be rebased"); }

  void say(const MoveKeyframe& op, std::vector<EditOperation>& out) {
    if (now_.keyframes().contains(op.id)) out.push_back(Carry(now_, corrections_).keyframe(op.id));
  }

  void say(const MoveLandmark& op, std::vector<EditOperation>& out) {
    const Landmark* before = old_.landmarks().find(op.id);
    if (!before || !now_.landmarks().contains(op.id)) return;
    const auto way = way_of_first(before->observations);
    if (!way) return;
    MoveLandmark moved{op.id, *way * op.point_in_world, {}};
    // Its look may have been renewed since: what it has now is turned.
    const auto carried = Carry(now_, corrections_).landmark(op.id);
    if (op.view_direction && carried) moved.view_direction = carried->view_direction;
    out.push_back(std::move(moved));
  }

  void say(const MovePlane& op, std::vector<EditOperation>& out) {
    const MappedPlane* before = old_.planes().find(op.id);
    if (!before || !now_.planes().contains(op.id)) return;
    if (const auto way = way_of_first(before->observations))
      out.push_back(MovePlane{op.id, op.plane.transformed(*way)});
  }

  void say(const MoveMarker& op, std::vector<EditOperation>& out) {
    const auto before = old_.markers().find(op.id);
    if (before == old_.markers().end() || !now_.markers().contains(op.id)) return;
    if (const auto way = way_of_first(before->second->observations))
      out.push_back(MoveMarker{op.id, (*way * op.world_from_marker).normalized()});
  }

  void say(const MergeLandmark& op, std::vector<EditOperation>& out) {
    const LandmarkId from = now_.landmarks().resolve(op.id), into = now_.landmarks().resolve(op.into);
    if (from.valid() && into.valid() && from != into) out.push_back(MergeLandmark{from, into});
  }
  void say(const MergePlane& op, std::vector<EditOperation>& out) {
    const PlaneId from = now_.planes().resolve(op.id), into = now_.planes().resolve(op.into);
    if (from.valid() && into.valid() && from != into) out.push_back(MergePlane{from, into});
  }
  void say(const RemoveObservation& op, std::vector<EditOperation>& out) {
    const LandmarkId landmark = now_.landmarks().resolve(op.landmark);
    if (landmark.valid()) out.push_back(RemoveObservation{landmark, op.keyframe});
  }
  // Rooms that were found or moved since stay: they are sought again once the map has moved.
  void say(const MoveStructureNodes& op, std::vector<EditOperation>& out) {
    if (&now_.structure() == &old_.structure()) out.push_back(op);
  }
  void say(const AddObservation& op, std::vector<EditOperation>& out) {
    const LandmarkId landmark = now_.landmarks().resolve(op.landmark);
    if (landmark.valid()) out.push_back(AddObservation{landmark, op.observation});
  }
  void say(const AddPlaneObservation& op, std::vector<EditOperation>& out) {
    const PlaneId plane = now_.planes().resolve(op.plane);
    if (plane.valid()) out.push_back(AddPlaneObservation{plane, op.observation});
  }
  template <typename Operation>
  void say(const Operation& op, std::vector<EditOperation>& out) {
    out.push_back(op);
  }

  void carry_new(std::vector<EditOperation>& out) const {
    for (EditOperation& move : carry(now_, corrections_, &old_)) out.push_back(std::move(move));
  }

  const MapEdit& edit_;
  const Map& old_;
  const Map& now_;
  const std::vector<Se3>& moved_;
  std::vector<std::optional<Se3>> edited_;  // by keyframe index of the old map
  Corrections corrections_;                 // of the present one
};

}  // namespace

MapEdit rebase(const MapEdit& edit, const Map& old_map, const Map& now, const std::vector<Se3>& moved) {
  if (edit.based_on == now.version()) return edit;
  return Rebaser(edit, old_map, now, moved).run();
}

}  // namespace vsgraphs
