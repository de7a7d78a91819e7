#include "core/map/map.h"

#include <algorithm>

#include "core/geometry/polygon.h"

namespace vsgraphs {

namespace {

// Goes on from a culled anchor to what that hangs on, until one lives; how many steps that takes. Empty if one never existed.
std::optional<int> go_on_to_living(const Map& map, AnchoredPose& pose) {
  int steps = 0;
  while (!map.keyframes().contains(pose.keyframe)) {
    const RetiredKeyframe* retired = map.retired_keyframes().find(pose.keyframe);
    if (!retired) return std::nullopt;
    pose = {retired->anchor, retired->anchor_from_camera * pose.keyframe_from_camera};
    ++steps;
  }
  return steps;
}

}  // namespace

std::optional<AnchoredPose> Map::reanchor(AnchoredPose pose) const {
  if (!go_on_to_living(*this, pose)) return std::nullopt;
  return pose;
}

std::optional<TrackedLink> Map::living_link(KeyframeId id) const {
  const Keyframe* keyframe = keyframes_.find(id);
  if (!keyframe || !keyframe->tracked_link) return std::nullopt;
  const TrackedLink& link = *keyframe->tracked_link;
  AnchoredPose pose{link.to, link.to_from_camera};
  const auto steps = go_on_to_living(*this, pose);
  if (!steps || pose.keyframe == id) return std::nullopt;
  return TrackedLink{pose.keyframe, pose.keyframe_from_camera, link.information / (1 + *steps)};
}

std::optional<Se3> Map::resolve(const AnchoredPose& pose) const {
  const auto living = reanchor(pose);
  if (!living) return std::nullopt;
  return keyframes_.find(living->keyframe)->world_from_camera * living->keyframe_from_camera;
}

KeyframeId Map::keyframe_of_frame(std::int64_t frame_index) const {
  for (std::uint32_t index = keyframes_.index_bound(); index-- > 0;) {
    const KeyframeId id = keyframes_.at_index(index);
    if (id.valid() && keyframes_.find(id)->frame_index == frame_index) return id;
  }
  return {};
}

RoomNumber Map::room_at(const Eigen::Vector3d& point_in_world) const {
  constexpr double below_ground_m = 0.3, usual_height_m = 3.0;
  const Eigen::Vector3d point = structure_->level_from_world * point_in_world;
  for (const FoundRoom& room : structure_->rooms) {
    const double above_m = point.z() - room.ground_m;
    if (above_m > -below_ground_m && above_m < room.height_m.value_or(usual_height_m) &&
        contains(room.polygon, point.head<2>()))
      return room.number;
  }
  return no_room;
}

std::vector<std::pair<KeyframeId, int>> Map::covisible(KeyframeId id, int min_shared) const {
  std::vector<std::pair<KeyframeId, int>> result;
  const Keyframe* keyframe = keyframes_.find(id);
  if (!keyframe) return result;
  std::vector<int> shared(keyframes_.index_bound(), 0);
  std::vector<KeyframeId> seen;
  for (const LandmarkId landmark_id : keyframe->landmarks) {
    const Landmark* landmark = landmarks_.find(landmark_id);
    if (!landmark) continue;
    for (const Observation& observation : landmark->observations) {
      if (shared[observation.keyframe.index]++ == 0) seen.push_back(observation.keyframe);
    }
  }
  for (const KeyframeId other : seen) {
    if (other != id && shared[other.index] >= min_shared) result.emplace_back(other, shared[other.index]);
  }
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second > b.second : a.first < b.first;
  });
  return result;
}

void Map::apply(const EditOperation& operation) {
  std::visit([this](const auto& op) { apply_one(op); }, operation);
}

void Map::apply(const MapEdit& edit) {
  for (const EditOperation& operation : edit.operations) apply(operation);
  ++version_;
}

Snapshot Map::snapshot() {
  auto copy = std::make_shared<const Map>(*this);
  keyframes_.seal();
  landmarks_.seal();
  planes_.seal();
  retired_.seal();
  return copy;
}

void Map::apply_one(const AddKeyframe& op) {
  Keyframe keyframe = op.keyframe;
  if (!keyframe.stretch.valid()) keyframe.stretch = op.id;
  keyframe.landmarks.assign(static_cast<std::size_t>(keyframe.features->size()), LandmarkId{});
  keyframes_.insert_at(op.id, std::move(keyframe));
  // Ids of retired keyframes are keyframe ids: the two tables grow together.
  retired_.insert_at(op.id, RetiredKeyframe{});
}

void Map::apply_one(const RemoveKeyframe& op) {
  const Keyframe* keyframe = keyframes_.find(op.id);
  const Keyframe* anchor = keyframes_.find(op.anchor);
  if (!keyframe || !anchor || op.id == op.anchor) return;
  *retired_.edit(op.id) = {op.anchor, anchor->world_from_camera.inverse() * keyframe->world_from_camera,
                           keyframe->patches, op.replaced, keyframe->stretch};
  const std::vector<LandmarkId> observed = keyframe->landmarks;
  for (const LandmarkId landmark : observed) {
    if (landmark.valid()) apply_one(RemoveObservation{landmark, op.id});
  }
  pass_on_steps(op.id);
  keyframes_.erase(op.id);
}

void Map::apply_one(const AddLandmark& op) { landmarks_.insert_at(op.id, op.landmark); }

void Map::detach(LandmarkId landmark, const Observation& observation) {
  Keyframe* keyframe = keyframes_.edit(observation.keyframe);
  if (keyframe && keyframe->landmarks[observation.feature] == landmark) {
    keyframe->landmarks[observation.feature] = LandmarkId{};
  }
}

void Map::apply_one(const RemoveLandmark& op) {
  const Landmark* landmark = landmarks_.find(op.id);
  if (!landmark) return;
  for (const Observation& observation : landmark->observations) detach(op.id, observation);
  landmarks_.erase(op.id);
}

void Map::apply_one(const MergeLandmark& op) {
  const Landmark* from = landmarks_.find(op.id);
  if (!from || !landmarks_.contains(op.into) || op.id == op.into) return;
  const std::vector<Observation> observations = from->observations;
  const CountSightings sightings{op.into, from->visible_count, from->found_count};
  for (const Observation& observation : observations) detach(op.id, observation);
  landmarks_.erase(op.id, op.into);
  for (const Observation& observation : observations) apply_one(AddObservation{op.into, observation});
  apply_one(sightings);
}

void Map::apply_one(const AddObservation& op) {
  const Landmark* landmark = landmarks_.find(op.landmark);
  const Keyframe* keyframe = keyframes_.find(op.observation.keyframe);
  if (!landmark || !keyframe || keyframe->landmarks[op.observation.feature].valid()) return;
  for (const Observation& other : landmark->observations) {
    if (other.keyframe == op.observation.keyframe) return;
  }
  keyframes_.edit(op.observation.keyframe)->landmarks[op.observation.feature] = op.landmark;
  landmarks_.edit(op.landmark)->observations.push_back(op.observation);
}

void Map::apply_one(const RemoveObservation& op) {
  Landmark* landmark = landmarks_.edit(op.landmark);
  if (!landmark) return;
  auto& observations = landmark->observations;
  const auto found = std::find_if(observations.begin(), observations.end(),
                                  [&op](const Observation& o) { return o.keyframe == op.keyframe; });
  if (found == observations.end()) return;
  detach(op.landmark, *found);
  observations.erase(found);
  // Nothing holds it in place any longer.
  if (observations.empty()) landmarks_.erase(op.landmark);
}

void Map::apply_one(const MoveKeyframe& op) {
  if (Keyframe* keyframe = keyframes_.edit(op.id)) keyframe->world_from_camera = op.world_from_camera;
}

void Map::apply_one(const MoveLandmark& op) {
  Landmark* landmark = landmarks_.edit(op.id);
  if (!landmark) return;
  landmark->point_in_world = op.point_in_world;
  if (op.view_direction) landmark->appearance.view_direction = *op.view_direction;
}

void Map::apply_one(const SetAppearance& op) {
  if (Landmark* landmark = landmarks_.edit(op.id)) landmark->appearance = op.appearance;
}

void Map::apply_one(const CountSightings& op) {
  if (Landmark* landmark = landmarks_.edit(op.id)) {
    landmark->visible_count += op.visible;
    landmark->found_count += op.found;
  }
}

}  // namespace vsgraphs
