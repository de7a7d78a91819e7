#include "core/understanding/marker_placing.h"

namespace vsgraphs {
namespace {

void forget_sights_of(KeyframeId keyframe, Draft& draft) {
  std::vector<MarkerId> seen;
  for (const auto& [id, marker] : draft.map().markers()) {
    for (const MarkerObservation& o : marker->observations) {
      if (o.keyframe == keyframe && (seen.empty() || seen.back() != id)) seen.push_back(id);
    }
  }
  for (const MarkerId id : seen) draft.record(RemoveMarkerObservations{id, keyframe});
}

// The first to see it may have been wrong, or the place seen first may be seen less often by now.
void stand_where_most_saw_it(MarkerId id, Draft& draft) {
  const MappedMarker& marker = *draft.map().markers().at(id);
  const MarkerSightings sightings = draft.map().sightings(marker);
  if (sightings.places.size() < 2) return;
  const Se3& first = sightings.places.front().world_from_marker;
  const auto away_m = [&](const MarkerSightings::Place& place) {
    return (place.world_from_marker.translation() - marker.world_from_marker.translation()).norm();
  };
  if (away_m(sightings.places[1]) < away_m(sightings.places[0])) draft.record(MoveMarker{id, first});
}

}  // namespace

MapEdit place_markers(KeyframeId keyframe, std::span<const MarkerDetection> detections,
                      const Snapshot& snapshot) {
  Draft draft(snapshot);
  const Keyframe* seeing = draft.map().keyframes().find(keyframe);
  if (!seeing) return draft.take();
  const Se3 world_from_camera = seeing->world_from_camera;
  forget_sights_of(keyframe, draft);
  for (const MarkerDetection& d : detections) {
    const auto mapped = draft.map().markers().find(d.id);
    if (mapped != draft.map().markers().end() && mapped->second->size_m != d.size_m)
      draft.record(RemoveMarker{d.id});
    draft.record(AddMarker{d.id, {d.size_m, world_from_camera * d.camera_from_marker, {}}});
    draft.record(AddMarkerObservation{d.id, {keyframe, d.camera_from_marker, d.covariance}});
    stand_where_most_saw_it(d.id, draft);
  }
  return draft.take();
}

}  // namespace vsgraphs
