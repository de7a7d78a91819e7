// From the map's structure to plain Python values.
#include <set>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "core/map/map.h"

namespace nb = nanobind;

namespace vsgraphs {
namespace {

nb::object vector_of(const Eigen::Vector3d& v) {
  return nb::cast(to_numpy(std::vector<double>{v.x(), v.y(), v.z()}, {3}));
}

nb::object id_or_none(std::uint32_t index, bool valid) { return valid ? nb::cast(index) : nb::none(); }

nb::dict plane_of(const Map& map, PlaneId id, const MappedPlane& plane) {
  std::vector<float> points;
  std::set<std::uint32_t> keyframes;
  for (const PlaneObservation& o : plane.observations) {
    keyframes.insert(o.keyframe.index);
    const auto pose = map.resolve({o.keyframe, Se3{}});
    const SurfacePatch* patch = map.patch(o);
    if (!pose || !patch) continue;
    for (const Eigen::Vector3f& p : patch->points) {
      const Eigen::Vector3d q = *pose * p.cast<double>();
      for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(q[k]));
    }
  }
  nb::dict votes;
  for (std::size_t r = 1; r < surface_role_count; ++r) {
    if (plane.votes[r] > 0) votes[to_string(static_cast<SurfaceRole>(r))] = plane.votes[r];
  }
  nb::list observed_by;
  for (const std::uint32_t k : keyframes) observed_by.append(k);
  nb::dict d;
  d["id"] = id.index;
  d["role"] = to_string(plane.role);
  d["votes"] = votes;
  d["normal"] = vector_of(plane.plane.normal);
  d["d"] = plane.plane.d();
  d["anchor"] = vector_of(plane.plane.project(plane.plane.anchor));
  d["other_face"] = id_or_none(plane.other_face.index, plane.other_face.valid());
  d["thickness_m"] = plane.thickness_m;
  const std::size_t n = points.size() / 3;
  d["points"] = to_numpy(std::move(points), {n, 3});
  d["observed_by"] = observed_by;
  return d;
}

}  // namespace

nb::dict scene_graph_of(const Map& map) {
  nb::dict graph;
  graph["up"] = map.up_in_world() ? vector_of(*map.up_in_world()) : nb::none();
  nb::list planes;
  map.planes().for_each([&](PlaneId id, const MappedPlane& plane) { planes.append(plane_of(map, id, plane)); });
  graph["planes"] = planes;
  return graph;
}

}  // namespace vsgraphs
