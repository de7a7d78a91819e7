// The part of the map that deals with there being several.
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
  const Se3& moved = op.world_from_other;
  absorb_markers(other, moved);
  if (!up_in_world_ && other.up_in_world_) up_in_world_ = moved.rotation() * *other.up_in_world_;
  if (other.structure_->next_number > structure_->next_number) {
    FoundStructure changed = *structure_;
    changed.next_number = other.structure_->next_number;
    structure_ = std::make_shared<const FoundStructure>(std::move(changed));
  }
  if (moved.matrix().isIdentity(0)) return;
  other.keyframes_.for_each([&](KeyframeId id, const Keyframe& keyframe) {
    keyframes_.edit(id)->world_from_camera = (moved * keyframe.world_from_camera).normalized();
  });
  other.landmarks_.for_each([&](LandmarkId id, const Landmark& was) {
    Landmark& landmark = *landmarks_.edit(id);
    landmark.point_in_world = moved * was.point_in_world;
    landmark.appearance.view_direction =
        (moved.rotation() * was.appearance.view_direction.cast<double>()).cast<float>();
  });
  other.planes_.for_each([&](PlaneId id, const MappedPlane& plane) {
    planes_.edit(id)->plane = plane.plane.transformed(moved);
  });
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
      united.world_from_marker = (world_from_other * theirs->world_from_marker).normalized();
    }
    ours = std::make_shared<const MappedMarker>(std::move(united));
  }
}

}  // namespace vsgraphs
