#include "core/tracking/plane_alignment.h"

#include <algorithm>
#include <cmath>

namespace vsgraphs {
namespace {

struct Candidate {
  Eigen::Vector3d normal_in_camera;
  double distance_m;  // of the camera
  const AnchoredPlane* plane;
};

std::vector<Candidate> planes_in_reach(const Map& map, const Se3& world_from_camera) {
  constexpr std::size_t min_observations = 3;
  constexpr double max_distance_m = 6.0;
  std::vector<Candidate> candidates;
  map.planes().for_each([&](PlaneId, const MappedPlane& mapped) {
    if (mapped.observations.size() < min_observations) return;
    const double distance = mapped.plane.signed_distance(world_from_camera.translation());
    if (distance <= 0.1 || distance > max_distance_m) return;
    candidates.push_back(
        {world_from_camera.rotation().transpose() * mapped.plane.normal, distance, &mapped.plane});
  });
  return candidates;
}

}  // namespace

std::vector<PointToPlane> rows_on_planes(const Map& map, const DepthGrid& now, const Se3& world_from_camera,
                                         double gate_m, const DepthNoise& noise,
                                         std::vector<std::uint8_t>* used) {
  constexpr double effective = 30;
  if (used) used->assign(now.samples.size(), 0);
  constexpr double min_normal_agreement = 0.9, frame_error_m = 0.01;
  const std::vector<Candidate> candidates = planes_in_reach(map, world_from_camera);
  std::vector<PointToPlane> rows;
  std::vector<std::size_t> row_candidate;
  std::vector<int> count(candidates.size(), 0);
  for (int r = 0; r < now.rows; r += 2) {
    for (int c = 0; c < now.columns; c += 2) {
      const SurfaceSample& sample = now.at(c, r);
      if (!sample.has_normal()) continue;
      const Eigen::Vector3d point = sample.point.cast<double>(), normal = sample.normal.cast<double>();
      const double sigma = noise.sigma_m(point.z());
      double nearest = gate_m + 3 * sigma;
      std::size_t best = candidates.size();
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const double off = std::abs(candidates[i].normal_in_camera.dot(point) + candidates[i].distance_m);
        if (off > nearest || candidates[i].normal_in_camera.dot(normal) < min_normal_agreement) continue;
        nearest = off;
        best = i;
      }
      if (best == candidates.size()) continue;
      const AnchoredPlane& plane = *candidates[best].plane;
      rows.push_back({point, plane.normal, plane.d(), 1 / std::hypot(sigma, frame_error_m)});
      row_candidate.push_back(best);
      ++count[best];
      if (used) (*used)[static_cast<std::size_t>(r * now.columns + c)] = 1;
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].inv_sigma *= std::sqrt(std::min(1.0, effective / count[row_candidate[i]]));
  return rows;
}

}  // namespace vsgraphs
