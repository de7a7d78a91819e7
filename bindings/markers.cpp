#include "bindings/markers.h"

#include <set>
#include <string>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "core/base/check.h"

namespace nb = nanobind;

namespace vsgraphs {
namespace {

void require_shape(const Reals& array, const char* name, std::initializer_list<std::size_t> shape) {
  bool as_expected = array.ndim() == shape.size();
  std::string expected;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const std::size_t side = *(shape.begin() + i);
    as_expected = as_expected && array.shape(i) == side;
    expected += (i ? ", " : "") + std::to_string(side);
  }
  require_input(as_expected, std::string("markers: ") + name + " must have the shape (" + expected +
                                 "), one for each of ids");
}

template <int side>
Eigen::Matrix<double, side, side> matrix_at(const Reals& array, std::size_t i) {
  using RowMajor = Eigen::Matrix<double, side, side, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.data() + i * static_cast<std::size_t>(side * side));
}

nb::list keyframes_of(const MappedMarker& marker, const MarkerSightings::Place& place) {
  std::set<std::uint32_t> keyframes;
  for (const std::size_t i : place.observations) keyframes.insert(marker.observations[i].keyframe.index);
  nb::list list;
  for (const std::uint32_t k : keyframes) list.append(k);
  return list;
}

}  // namespace

MarkerDetections marker_detections_of(const Numbers& ids, const Reals& sizes, const Reals& poses,
                                      const Reals& covariances) {
  const std::size_t n = ids.shape(0);
  require_shape(sizes, "size_m", {n});
  require_shape(poses, "camera_from_marker", {n, 4, 4});
  require_shape(covariances, "covariance", {n, 6, 6});
  MarkerDetections detections(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t number = ids.data()[i];
    require_input(number >= 0 && number <= 0xffffffffLL,
                  "markers: " + std::to_string(number) + " is no marker's number");
    const Eigen::Matrix4d pose = matrix_at<4>(poses, i);
    require_input(pose.row(3) == Eigen::RowVector4d(0, 0, 0, 1),
                  "markers: the last row of a pose must be 0 0 0 1");
    detections[i] = {{static_cast<std::uint32_t>(number)},
                     sizes.data()[i],
                     Se3::from_matrix(pose),
                     matrix_at<6>(covariances, i)};
  }
  return detections;
}

nb::list markers_of(const Map& map) {
  nb::list markers;
  for (const auto& [id, marker] : map.markers()) {
    const MarkerSightings sightings = map.sightings(*marker);
    if (sightings.places.empty()) continue;
    nb::list places;
    for (const MarkerSightings::Place& place : sightings.places) {
      const Eigen::Vector3d& at = place.world_from_marker.translation();
      nb::dict p;
      p["position"] = to_numpy(std::vector<double>{at.x(), at.y(), at.z()}, {3});
      p["observed_by"] = keyframes_of(*marker, place);
      places.append(p);
    }
    std::vector<double> pose;
    append_rows(pose, marker->world_from_marker);
    nb::dict d;
    d["id"] = id.number;
    d["size_m"] = marker->size_m;
    d["world_from_marker"] = to_numpy(std::move(pose), {4, 4});
    d["observed_by"] = keyframes_of(*marker, sightings.places.front());
    d["in_two_places"] = sightings.in_two_places();
    d["places"] = places;
    markers.append(d);
  }
  return markers;
}

}  // namespace vsgraphs
