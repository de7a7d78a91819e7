#include "core/tracking/depth_alignment.h"

#include <algorithm>
#include <cmath>

#include "core/tracking/plane_alignment.h"

namespace vsgraphs {

namespace {

constexpr int min_samples = 150;
constexpr double agreeing_share = 0.6;
constexpr double wide_gate_m = 10.0;  // whatever lies elsewhere is a contradiction, not a missing match
// Neighbouring samples err together (the sensor's noise is smooth, its calibration wrong everywhere alike): all of
// them count as this many independent ones.
constexpr double effective_samples = 60;

}  // namespace

bool DepthAlignment::convincing() const {
  return associated >= min_samples && agreeing >= agreeing_share * associated;
}

bool DepthAlignment::contradicts() const { return associated >= min_samples && !convincing(); }

std::vector<PointToPlane> DepthAligner::associate(const DepthGrid& now, const SurfaceReference& reference,
                                                  const Se3& pose, double gate_m,
                                                  const std::vector<std::uint8_t>& skip) const {
  constexpr float min_normal_agreement = 0.85F;
  const Se3 reference_from_now = reference.world_from_surface.inverse() * pose;
  const Eigen::Matrix3f turn = reference_from_now.rotation().cast<float>();
  std::vector<PointToPlane> rows;
  for (int r = 0; r < now.rows; r += 2) {
    for (int c = 0; c < now.columns; c += 2) {
      const SurfaceSample& sample = now.at(c, r);
      if (!sample.has_normal()) continue;
      if (!skip.empty() && skip[static_cast<std::size_t>(r * now.columns + c)]) continue;
      const Eigen::Vector3d point = reference_from_now * sample.point.cast<double>();
      const SurfaceSample* surface = sampler_.look_up(*reference.grid, point);
      if (!surface || !surface->has_normal()) continue;
      const Eigen::Vector3d normal = surface->normal.cast<double>();
      if (std::abs(normal.dot(point - surface->point.cast<double>())) > gate_m) continue;
      if (surface->normal.dot(turn * sample.normal) < min_normal_agreement) continue;
      PointToPlane row;
      row.point_in_camera = sample.point.cast<double>();
      row.normal_in_world = reference.world_from_surface.rotation() * normal;
      row.offset_m = -row.normal_in_world.dot(reference.world_from_surface * surface->point.cast<double>());
      const double sigma = std::hypot(camera_.depth_noise.sigma_m(row.point_in_camera.z()),
                                      camera_.depth_noise.sigma_m(static_cast<double>(surface->point.z())));
      row.inv_sigma = 1.0 / sigma;
      rows.push_back(row);
    }
  }
  return rows;
}

// Agreement is judged at full weight; the information is that of correlated samples.
void DepthAligner::count(const std::vector<PointToPlane>& rows, const Se3& pose,
                         DepthAlignment& result) const {
  constexpr double agreeing_sigmas = 3.0;
  result.associated = static_cast<int>(rows.size());
  for (const PointToPlane& row : rows) {
    Vector6d jacobian;
    if (std::abs(point_to_plane(pose, row, &jacobian)) > agreeing_sigmas) continue;
    ++result.agreeing;
    result.surface_information += jacobian * jacobian.transpose();
  }
  if (result.agreeing > 0) result.surface_information *= std::min(1.0, effective_samples / result.agreeing);
}

DepthAlignment DepthAligner::judge(const DepthGrid& now, const SurfaceReference& reference,
                                   const Se3& world_from_camera) const {
  DepthAlignment result;
  result.solution.world_from_camera = world_from_camera;
  count(associate(now, reference, world_from_camera, wide_gate_m), world_from_camera, result);
  return result;
}

DepthAlignment DepthAligner::align(const Map& map, const DepthGrid& now, const SurfaceReference& reference,
                                   const Se3& initial, std::span<const PoseObservation> features,
                                   const PosePriorTerm& prior) const {
  constexpr int iterations = 8;
  constexpr double first_gate_m = 0.4, last_gate_m = 0.08;
  DepthAlignment result;
  Se3 pose = initial;
  std::vector<std::uint8_t> on_plane;
  for (int i = 0; i < iterations; ++i) {
    const double gate =
        first_gate_m * std::pow(last_gate_m / first_gate_m, static_cast<double>(i) / (iterations - 1));
    // Where a mapped plane is known, it stands for the reference's samples: their normals are noisy, and noise of
    // normals holds a camera before a bare wall in directions that nothing measures, a little wrong in each frame.
    const auto on_planes =
        rows_on_planes(map, now, pose, std::min(gate, 0.15), camera_.depth_noise, &on_plane);
    std::vector<PointToPlane> weighted = associate(now, reference, pose, gate, on_plane);
    const double weight = std::sqrt(std::min(
        1.0, effective_samples / std::max(1.0, static_cast<double>(weighted.size() + on_planes.size()))));
    for (PointToPlane& row : weighted) row.inv_sigma *= weight;
    weighted.insert(weighted.end(), on_planes.begin(), on_planes.end());
    PoseSolverOptions options;
    options.rounds = i + 1 < iterations ? 1 : 2;
    options.iterations_per_round = 4;
    result.solution = solve_pose(Intrinsics::of(camera_), pose, features, weighted, prior, options);
    pose = result.solution.world_from_camera;
  }
  count(associate(now, reference, pose, wide_gate_m), pose, result);
  return result;
}

}  // namespace vsgraphs
