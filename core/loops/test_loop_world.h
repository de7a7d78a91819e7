// A map to close loops in: a camera in the middle of a square room turns round and round while its map drifts, so that what
// it sees in the second turn is mapped a second time, a little off.
#pragma once

#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/loops/test_loop_room.h"
#include "core/map/test_map.h"
#include "core/vision/place_index.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs::test {

struct LoopWorldOptions {
  int keyframes = 34;
  int per_turn = 30;
  Vector6d drift_per_step = Vector6d::Zero();  // of the whole camera about the world's origin (rho, phi)
  double half_width_m = 3.0;
  double second_half_width_m = 3.0;  // where surfaces stand in the second turn; features stay
  double second_patch_turn_rad = 0;  // by which patches of the second turn are turned about the vertical
  bool patches = true;
  bool grids = true;
  int ghost = -1;  // the last keyframe also shows, without knowing it, what this keyframe saw
  // The second turn is done in another room that looks the same and stands here.
  Eigen::Vector3d second_room_at = Eigen::Vector3d::Zero();
};

class LoopWorld {
 public:
  explicit LoopWorld(const LoopWorldOptions& options) : options_(options) {
    make_points();
    for (int k = 0; k < options.keyframes; ++k) add(k);
  }

  Camera camera;
  ScalePyramid pyramid;
  Map map;
  PlaceIndex places;
  std::vector<KeyframeId> ids;
  std::vector<Se3> truth;

  // How far a keyframe of the map is from where it belongs, m.
  double error_m(const Map& m, int k) const {
    const KeyframeId id = ids[static_cast<std::size_t>(k)];
    return (m.keyframes().find(id)->world_from_camera.translation() -
            truth[static_cast<std::size_t>(k)].translation())
        .norm();
  }

 private:
  bool second(int k) const { return k >= options_.per_turn; }
  void make_points() {
    Rng rng(1, "loop_world", 0);
    const double w = options_.half_width_m;
    for (int i = 0; i < 2400; ++i) {
      const double along = rng.uniform(-w, w), up = rng.uniform(-1.4, 1.4);
      const Se3 quarter(so3_exp({0, i % 4 * std::numbers::pi / 2, 0}), Eigen::Vector3d::Zero());
      points_.push_back(quarter * Eigen::Vector3d(along, up, w));
    }
  }

  // Half a metre from the room's middle, looking away from it.
  Se3 pose_in_room(int k) const {
    const Eigen::Matrix3d turn = so3_exp({0, 2 * std::numbers::pi * k / options_.per_turn, 0});
    return {turn, turn * Eigen::Vector3d(0, 0, 0.5)};
  }

  void add(int k) {
    const Se3 in_room = pose_in_room(k);
    const Eigen::Vector3d room_at = second(k) ? options_.second_room_at : Eigen::Vector3d::Zero();
    const Se3 world_from_room(Eigen::Matrix3d::Identity(), room_at);
    truth.push_back(world_from_room * in_room);
    mapped_.push_back(Se3::exp(k * options_.drift_per_step) * truth.back());
    Keyframe keyframe;
    std::vector<int> visible;
    const bool haunted = options_.ghost >= 0 && k + 1 == options_.keyframes;
    keyframe.features = features_from(in_room, haunted, visible);
    keyframe.frame_index = 10 * k;
    keyframe.world_from_camera = mapped_.back();
    if (k > 0 && room_at != Eigen::Vector3d::Zero() && k == options_.per_turn) link(keyframe, k);
    add_surfaces(keyframe, in_room, k);
    ids.push_back(add_keyframe(map, keyframe));
    places.add(ids.back(), *keyframe.features);
    observe(k, in_room, visible);
  }

  // A step between rooms, where no landmark is shared, was tracked all the same.
  void link(Keyframe& keyframe, int k) const {
    const auto last = static_cast<std::size_t>(k) - 1;
    keyframe.tracked_link = {ids[last], mapped_[last].inverse() * mapped_[last + 1],
                             1e5 * Matrix6d::Identity()};
  }

  std::shared_ptr<const FeatureSet> features_from(const Se3& pose, bool haunted,
                                                  std::vector<int>& visible) const {
    std::vector<Feature> features;
    std::vector<Descriptor> descriptors;
    visible = show(pose, features, descriptors);
    if (haunted) show(pose_in_room(options_.ghost), features, descriptors);
    return std::make_shared<const FeatureSet>(std::move(features), std::move(descriptors), camera.width,
                                              camera.height);
  }

  // The points in view, in order; appends how they look.
  std::vector<int> show(const Se3& pose, std::vector<Feature>& features,
                        std::vector<Descriptor>& descriptors) const {
    std::vector<int> visible;
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      const Eigen::Vector3d p = pose.inverse() * points_[static_cast<std::size_t>(i)];
      if (p.z() < 0.5) continue;
      const Eigen::Vector2d pixel = camera.project(p);
      if (!camera.contains(pixel.x(), pixel.y())) continue;
      visible.push_back(i);
      features.push_back(feature_of(camera, pose, points_[static_cast<std::size_t>(i)]));
      descriptors.push_back(descriptor_of(i));
    }
    return visible;
  }

  // Which turn a sight belongs to: what is seen again a turn later has been mapped anew.
  int turn_of(int k, const Eigen::Vector3d& point) const {
    const double turns = static_cast<double>(k) / options_.per_turn;
    const double at = std::atan2(point.x(), point.z()) / (2 * std::numbers::pi);
    return static_cast<int>(std::lround(turns - at)) +
           (second(k) && options_.second_room_at.norm() > 0 ? 10 : 0);
  }

  void observe(int k, const Se3& in_room, const std::vector<int>& visible) {
    const Se3& mapped = mapped_[static_cast<std::size_t>(k)];
    for (std::size_t f = 0; f < visible.size(); ++f) {
      const Eigen::Vector3d& point = points_[static_cast<std::size_t>(visible[f])];
      const Observation observation{ids[static_cast<std::size_t>(k)], static_cast<std::uint16_t>(f)};
      const auto key = std::make_pair(visible[f], turn_of(k, point));
      if (const auto known = landmarks_.find(key); known != landmarks_.end()) {
        map.apply(AddObservation{known->second, observation});
        continue;
      }
      const Eigen::Vector3d in_camera = in_room.inverse() * point;
      Landmark landmark;
      landmark.point_in_world = mapped * in_camera;
      landmark.appearance.descriptor = descriptor_of(visible[f]);
      landmark.appearance.view_direction = (mapped.rotation() * in_camera).normalized().cast<float>();
      landmark.appearance.reference_distance_m = static_cast<float>(in_camera.norm());
      const LandmarkId id = map.landmarks().next_id();
      map.apply(AddLandmark{id, landmark});
      map.apply(AddObservation{id, observation});
      landmarks_[key] = id;
    }
  }

  void add_surfaces(Keyframe& keyframe, const Se3& in_room, int k) const {
    const double half_width = second(k) ? options_.second_half_width_m : options_.half_width_m;
    const auto grid = std::make_shared<const DepthGrid>(grid_of(camera, in_room, square_room(half_width)));
    if (options_.grids) keyframe.surface = grid;
    if (!options_.patches) return;
    auto surfaces = std::make_shared<KeyframeSurfaces>();
    const double turn = second(k) ? options_.second_patch_turn_rad : 0;
    for (const Wall& wall : square_room(half_width)) {
      if (auto patch = patch_on(*grid, in_room, wall, turn)) surfaces->patches.push_back(std::move(*patch));
    }
    keyframe.patches = surfaces;
  }

  LoopWorldOptions options_;
  Points points_;
  std::vector<Se3> mapped_;
  std::map<std::pair<int, int>, LandmarkId> landmarks_;
};

}  // namespace vsgraphs::test
