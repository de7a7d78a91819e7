#include "core/mapping/landmark_creation.h"

#include <array>

#include "core/matching/appearance.h"
#include "core/solve/triangulate.h"
#include "core/vision/matching.h"

namespace vsgraphs {

namespace {

LandmarkId add_landmark(const Eigen::Vector3d& point, std::int64_t frame_index,
                        const std::vector<Observation>& observations, Draft& draft) {
  Landmark landmark;
  landmark.point_in_world = point;
  landmark.created_at_frame = frame_index;
  // Its maker has seen it.
  landmark.visible_count = landmark.found_count = 1;
  landmark.observations = observations;
  if (const auto appearance = summarise_appearance(draft.map(), landmark)) landmark.appearance = *appearance;
  const LandmarkId id = draft.add(std::move(landmark));
  for (const Observation& o : observations) draft.record(AddObservation{id, o});
  return id;
}

std::vector<int> features_without(const Keyframe& keyframe, bool with_depth) {
  std::vector<int> result;
  for (int i = 0; i < keyframe.features->size(); ++i) {
    if (keyframe.landmarks[static_cast<std::size_t>(i)].valid()) continue;
    if ((*keyframe.features)[i].has_depth() && !with_depth) continue;
    result.push_back(i);
  }
  return result;
}

// Fundamental matrix in undistorted pixels: x_b^T F x_a = 0.
Eigen::Matrix3d fundamental(const Camera& camera, const Se3& b_from_a) {
  Eigen::Matrix3d k_inverse = Eigen::Matrix3d::Identity();
  k_inverse(0, 0) = 1.0 / camera.fx;
  k_inverse(1, 1) = 1.0 / camera.fy;
  k_inverse(0, 2) = -camera.cx / camera.fx;
  k_inverse(1, 2) = -camera.cy / camera.fy;
  return k_inverse.transpose() * skew(b_from_a.translation()) * b_from_a.rotation() * k_inverse;
}

ViewOfPoint view_of(const Camera& camera, const ScalePyramid& pyramid, const Keyframe& keyframe,
                    int feature) {
  const Feature& f = (*keyframe.features)[feature];
  ViewOfPoint view;
  view.world_from_camera = keyframe.world_from_camera;
  view.measurement.u = f.u;
  view.measurement.v = f.v;
  view.measurement.inv_sigma_px = 1.0 / pyramid.level_sigma_px(f.level);
  if (f.has_depth()) {
    view.measurement.inverse_depth = 1.0 / static_cast<double>(f.depth_m);
    view.measurement.inv_sigma_inverse_depth =
        inv_sigma_of_inverse_depth(camera.depth_noise, static_cast<double>(f.depth_m));
  }
  return view;
}

}  // namespace

std::vector<LandmarkId> create_from_depth(const Camera& camera, KeyframeId id, Draft& draft) {
  std::vector<LandmarkId> made;
  const Keyframe keyframe = *draft.map().keyframes().find(id);
  for (int i = 0; i < keyframe.features->size(); ++i) {
    const Feature& feature = (*keyframe.features)[i];
    if (!feature.has_depth() || keyframe.landmarks[static_cast<std::size_t>(i)].valid()) continue;
    const Eigen::Vector3d point =
        keyframe.world_from_camera * camera.unproject(feature.u, feature.v, feature.depth_m);
    made.push_back(add_landmark(point, keyframe.frame_index, {{id, static_cast<std::uint16_t>(i)}}, draft));
  }
  return made;
}

std::vector<LandmarkId> create_by_triangulation(const Camera& camera, const ScalePyramid& pyramid,
                                                KeyframeId id, const std::vector<KeyframeId>& neighbours,
                                                Draft& draft) {
  constexpr double min_baseline_m = 0.03;
  std::vector<LandmarkId> made;
  for (const KeyframeId neighbour_id : neighbours) {
    const Keyframe keyframe = *draft.map().keyframes().find(id);
    const Keyframe neighbour = *draft.map().keyframes().find(neighbour_id);
    const Se3 neighbour_from_keyframe = neighbour.world_from_camera.inverse() * keyframe.world_from_camera;
    if (neighbour_from_keyframe.translation().norm() < min_baseline_m) continue;
    const std::vector<int> open = features_without(keyframe, false);
    const std::vector<int> open_there = features_without(neighbour, true);
    MatchOptions options;
    options.max_distance = 50;
    options.ratio = 0.9;
    options.check_rotation = true;
    constexpr double max_sigmas = 2.0;
    for (const auto& [i, j] :
         match_epipolar(*keyframe.features, open, *neighbour.features, open_there,
                        fundamental(camera, neighbour_from_keyframe), pyramid, max_sigmas, options)) {
      const std::array<ViewOfPoint, 2> views{view_of(camera, pyramid, keyframe, i),
                                             view_of(camera, pyramid, neighbour, j)};
      const auto point = triangulate(Intrinsics::of(camera), views);
      if (!point) continue;
      made.push_back(add_landmark(
          *point, keyframe.frame_index,
          {{id, static_cast<std::uint16_t>(i)}, {neighbour_id, static_cast<std::uint16_t>(j)}}, draft));
    }
  }
  return made;
}

}  // namespace vsgraphs
