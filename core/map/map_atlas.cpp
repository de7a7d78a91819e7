// The part of the map that deals with there being several.
#include "core/map/carry.h"
#include "core/map/map.h"

namespace vsgraphs {

FirstIds Map::unused_ids() const {
  const auto whole_chunks = [](std::uint32_t bound) { return (bound + 63) / 64 * 64; };
  return {whole_chunks(keyframes_.index_bound()), whole_chunks(landmarks_.index_bound()),
          whole_chunks(planes_.index_bound())};
}

void Map::apply_one(const OpenMap& op) {
  keyframes_.start_at(op.first.keyframe);
  retired_.start_at(op.first.keyframe);
  landmarks_.start_at(op.first.landmark);
  planes_.start_at(op.first.plane);
  version_ = op.version;
}

void Map::apply_one(const AbsorbMap& op) {
  const Map& other = *op.other;
  keyframes_.absorb(other.keyframes_);
  retired_.absorb(other.retired_);
  landmarks_.absorb(other.landmarks_);
  planes_.absorb(other.planes_);
  const Se3& by = op.world_from_other;
  absorb_markers(other, by);
  if (!up_in_world_ && other.up_in_world_) up_in_world_ = by.rotation() * *other.up_in_world_;
  if (other.structure_->next_number > structure_->next_number) {
    FoundStructure changed = *structure_;
    changed.next_number = other.structure_->next_number;
    structure_ = std::make_shared<const FoundStructure>(std::move(changed));
  }
  apply_one(NameClasses{*other.class_names_});
  if (by.matrix().isIdentity(0)) return;
  const auto move = [this, &by](auto id, const auto& thing) { apply_one(moved(id, thing, by)); };
  other.keyframes_.for_each(move);
  other.landmarks_.for_each(move);
  other.planes_.for_each(move);
}

// A number both maps know is one marker: what both saw of it counts, and it stays where this map has it.
void Map::absorb_markers(const Map& other, const Se3& world_from_other) {
  for (const auto& [id, theirs] : other.markers_) {
    std::shared_ptr<const MappedMarker>& ours = markers_[id];
    MappedMarker united = ours ? *ours : *theirs;
    if (ours) {
      united.observations.insert(united.observations.end(), theirs->observations.begin(),
                                 theirs->observations.end());
    } else {
      united.world_from_marker = moved(id, *theirs, world_from_other).world_from_marker;
    }
    ours = std::make_shared<const MappedMarker>(std::move(united));
  }
}

}  // namespace vsgraphs
