// A fiducial marker of the world that keyframes observe: a rigid pose, a variable of the factor graph. The printed number is
// its key, so that no matching is needed; two prints of one number are told from one by where they are seen.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/base/fields.h"
#include "core/geometry/se3.h"
#include "core/map/ids.h"

namespace vsgraphs {

// The number in the dictionary it was printed from.
struct MarkerId {
  std::uint32_t number = 0;
  auto operator<=>(const MarkerId&) const = default;
};
template <FieldsOf<MarkerId> T>
void visit_fields(T& v, auto& field) {
  field(v.number);
}

struct MarkerObservation {
  KeyframeId keyframe;  // may be retired: what it saw still stands where it stood (Map::reanchor)
  Se3 camera_from_marker;
  Matrix6d covariance = Matrix6d::Identity();  // tangent (m, rad) on the right of camera_from_marker
};
template <FieldsOf<MarkerObservation> T>
void visit_fields(T& v, auto& field) {
  auto& [keyframe, camera_from_marker, covariance] = v;
  field(keyframe, camera_from_marker, covariance);
}

struct MappedMarker {
  double size_m = 0;      // side of the black square
  Se3 world_from_marker;  // origin in its middle; x to the right of who reads it, y up, z out of the paper
  std::vector<MarkerObservation> observations;  // in the order they were made; all places it was seen in
};
template <FieldsOf<MappedMarker> T>
void visit_fields(T& v, auto& field) {
  auto& [size_m, world_from_marker, observations] = v;
  field(size_m, world_from_marker, observations);
}
template <>
inline constexpr const char* shared_name<MappedMarker> = "markers";

// Values never change once they are in: an edit puts a new one in their place, so that copies of the map share them.
using Markers = std::map<MarkerId, std::shared_ptr<const MappedMarker>>;

// A marker's observations by where they say it hangs, as the keyframes stand now.
struct MarkerSightings {
  struct Place {
    std::vector<std::size_t> observations;  // indices, ascending
    Se3 world_from_marker;                  // as the first of them has it
  };
  std::vector<Place>
      places;  // most observations first, then the older one; none: no keyframe is left that saw it

  // Two prints carry the number: a second place was seen more than once. One stray reading is only set aside.
  bool in_two_places() const { return places.size() > 1 && places[1].observations.size() > 1; }
};

}  // namespace vsgraphs
