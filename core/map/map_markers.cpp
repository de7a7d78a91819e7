// The part of the map that deals with markers.
#include <algorithm>

#include "core/map/map.h"

namespace vsgraphs {

namespace {

// Poses farther apart are not one print of the number: beyond what keyframes drift between two sights of a room, and turned to
// another side (the two faces of one wall are near to each other).
bool same_place(const Se3& a, const Se3& b) {
  constexpr double nearby_m = 0.5;
  const double facing = a.rotation().col(2).dot(b.rotation().col(2));
  return (a.translation() - b.translation()).norm() < nearby_m && facing > 0;
}

template <typename Change>
void change(Markers& markers, MarkerId id, Change&& change_it) {
  const auto at = markers.find(id);
  if (at == markers.end()) return;
  MappedMarker changed = *at->second;
  change_it(changed);
  at->second = std::make_shared<const MappedMarker>(std::move(changed));
}

}  // namespace

MarkerSightings Map::sightings(const MappedMarker& marker) const {
  MarkerSightings found;
  for (std::size_t i = 0; i < marker.observations.size(); ++i) {
    const MarkerObservation& o = marker.observations[i];
    const auto pose = resolve({o.keyframe, o.camera_from_marker});
    if (!pose) continue;
    auto place = std::find_if(found.places.begin(), found.places.end(),
                              [&](const auto& p) { return same_place(p.world_from_marker, *pose); });
    if (place == found.places.end()) place = found.places.insert(place, {{}, *pose});
    place->observations.push_back(i);
  }
  std::stable_sort(found.places.begin(), found.places.end(), [](const auto& a, const auto& b) {
    return a.observations.size() > b.observations.size();
  });
  return found;
}

void Map::apply_one(const AddMarker& op) {
  MappedMarker marker = op.marker;
  marker.observations.clear();
  markers_.try_emplace(op.id, std::make_shared<const MappedMarker>(std::move(marker)));
}

void Map::apply_one(const RemoveMarker& op) { markers_.erase(op.id); }

void Map::apply_one(const AddMarkerObservation& op) {
  if (!reanchor({op.observation.keyframe, Se3{}})) return;
  change(markers_, op.id, [&op](MappedMarker& marker) { marker.observations.push_back(op.observation); });
}

void Map::apply_one(const RemoveMarkerObservations& op) {
  const auto at = markers_.find(op.id);
  if (at == markers_.end()) return;
  const auto its_own = [&op](const MarkerObservation& o) { return o.keyframe == op.keyframe; };
  const auto& observations = at->second->observations;
  if (std::all_of(observations.begin(), observations.end(), its_own)) {
    markers_.erase(at);  // nothing holds it in place any longer
    return;
  }
  change(markers_, op.id, [&its_own](MappedMarker& marker) { std::erase_if(marker.observations, its_own); });
}

void Map::apply_one(const MoveMarker& op) {
  change(markers_, op.id, [&op](MappedMarker& marker) { marker.world_from_marker = op.world_from_marker; });
}

}  // namespace vsgraphs
