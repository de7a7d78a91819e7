// The part of the map a frame can be matched against: landmarks of the keyframes that see what the frame sees.
// Idea: the local map of PTAM and ORB-SLAM (Mur-Artal, Montiel, Tardos, T-RO 2015, section V-D).
#pragma once

#include <span>
#include <vector>

#include "core/geometry/camera.h"
#include "core/map/map.h"
#include "core/vision/matching.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

// Where a landmark should appear in a camera at a given pose, and whether it can be recognised from there.
struct LandmarkView {
  LandmarkId id;
  Eigen::Vector3d point_in_world;
  ProjectedPoint projection;
};

// Projects a landmark. False if it is behind the camera, outside the image, too near or too far for its scale,
// or seen from another side (more than 60 deg off) than before.
bool project_landmark(const Camera& camera, const ScalePyramid& pyramid, const Se3& camera_from_world,
                      LandmarkId id, const Landmark& landmark, double radius_px, LandmarkView& view);

class LocalMap {
 public:
  // Chooses up to `max_keyframes` keyframes by votes of the landmarks a frame sees (ties: lower id), filled up
  // with the neighbours of the strongest, and gathers their landmarks in a fixed order.
  // Cost: linear in the observations of `seen` and the features of the chosen keyframes.
  void select(const Map& map, std::span<const LandmarkId> seen, KeyframeId fallback, int max_keyframes);

  // The keyframe with most votes; invalid if there was nothing to vote.
  KeyframeId reference() const { return reference_; }
  // How many of the landmarks seen it observes.
  int reference_votes() const { return reference_.valid() ? votes_[reference_.index] : 0; }
  const std::vector<KeyframeId>& keyframes() const { return keyframes_; }
  const std::vector<LandmarkId>& landmarks() const { return landmarks_; }

 private:
  void vote(const Map& map, std::span<const LandmarkId> seen);
  void add_neighbours(const Map& map, std::size_t max_keyframes);
  void gather_landmarks(const Map& map);
  bool chosen(KeyframeId id) const;

  std::vector<int> votes_;  // by keyframe index
  std::vector<KeyframeId> voters_;
  std::vector<KeyframeId> keyframes_;
  std::vector<LandmarkId> landmarks_;
  std::vector<std::uint32_t> gathered_;  // by landmark index: the pass that took it
  std::uint32_t pass_ = 0;
  KeyframeId reference_;
};

}  // namespace vsgraphs
