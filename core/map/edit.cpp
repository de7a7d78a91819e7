#include "core/map/edit.h"

#include <bit>

#include "core/map/map.h"

namespace vsgraphs {

namespace {

class Fnv1a {
 public:
  void word(std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) {
      hash_ = (hash_ ^ ((value >> (8 * byte)) & 0xff)) * 0x100000001b3ULL;
    }
  }
  void number(double value) { word(std::bit_cast<std::uint64_t>(value)); }
  template <typename Tag>
  void id(const Id<Tag>& value) {
    word((static_cast<std::uint64_t>(value.generation) << 32) | value.index);
  }
  template <typename Derived>
  void matrix(const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index c = 0; c < m.cols(); ++c)
      for (Eigen::Index r = 0; r < m.rows(); ++r) number(static_cast<double>(m(r, c)));
  }
  void pose(const Se3& pose) {
    matrix(pose.rotation());
    matrix(pose.translation());
  }
  void appearance(const Appearance& a) {
    for (const std::uint64_t w : a.descriptor.words) word(w);
    matrix(a.view_direction);
    number(static_cast<double>(a.reference_distance_m));
    word(a.reference_level);
  }
  std::uint64_t value() const { return hash_; }

  void plane(const AnchoredPlane& p) {
    matrix(p.normal);
    matrix(p.anchor);
    number(p.offset_m);
  }
  void votes(const RoleVotes& votes) {
    for (const float v : votes) number(static_cast<double>(v));
  }
  void observation(const PlaneObservation& o) {
    id(o.keyframe);
    word(o.patch);
  }

  void operator()(const AddKeyframe& op) {
    id(op.id);
    word(static_cast<std::uint64_t>(op.keyframe.frame_index));
    number(op.keyframe.timestamp_s);
    pose(op.keyframe.world_from_camera);
    if (op.keyframe.tracked_link) {
      id(op.keyframe.tracked_link->to);
      pose(op.keyframe.tracked_link->to_from_camera);
      matrix(op.keyframe.tracked_link->information);
    }
    for (const Descriptor& d : op.keyframe.features->descriptors()) {
      for (const std::uint64_t w : d.words) word(w);
    }
  }
  void operator()(const RemoveKeyframe& op) {
    id(op.id);
    id(op.anchor);
  }
  void operator()(const AddLandmark& op) {
    id(op.id);
    matrix(op.landmark.point_in_world);
    appearance(op.landmark.appearance);
  }
  void operator()(const RemoveLandmark& op) { id(op.id); }
  void operator()(const MergeLandmark& op) {
    id(op.id);
    id(op.into);
  }
  void operator()(const AddObservation& op) {
    id(op.landmark);
    id(op.observation.keyframe);
    word(op.observation.feature);
  }
  void operator()(const RemoveObservation& op) {
    id(op.landmark);
    id(op.keyframe);
  }
  void operator()(const MoveKeyframe& op) {
    id(op.id);
    pose(op.world_from_camera);
  }
  void operator()(const MoveLandmark& op) {
    id(op.id);
    matrix(op.point_in_world);
  }
  void operator()(const SetAppearance& op) {
    id(op.id);
    appearance(op.appearance);
  }
  void operator()(const CountSightings& op) {
    id(op.id);
    word((static_cast<std::uint64_t>(op.visible) << 32) | op.found);
  }
  void operator()(const SetPatches& op) {
    id(op.id);
    word(op.patches->labelled);
    for (const SurfacePatch& patch : op.patches->patches) {
      plane(patch.plane);
      matrix(patch.information);
      votes(patch.votes);
      word(static_cast<std::uint64_t>(patch.samples));
      number(static_cast<double>(patch.area_m2));
    }
  }
  void operator()(const AddPlane& op) {
    id(op.id);
    plane(op.plane.plane);
    word(static_cast<std::uint64_t>(op.plane.role));
    votes(op.plane.votes);
  }
  void operator()(const RemovePlane& op) { id(op.id); }
  void operator()(const MergePlane& op) {
    id(op.id);
    id(op.into);
  }
  void operator()(const AddPlaneObservation& op) {
    id(op.plane);
    observation(op.observation);
  }
  void operator()(const RemovePlaneObservation& op) {
    id(op.plane);
    observation(op.observation);
  }
  void operator()(const MovePlane& op) {
    id(op.id);
    plane(op.plane);
  }
  void operator()(const ClassifyPlane& op) {
    id(op.id);
    word(static_cast<std::uint64_t>(op.role));
    votes(op.votes);
  }
  void operator()(const PairFaces& op) {
    id(op.id);
    id(op.other);
    number(op.thickness_m);
  }
  void operator()(const SetUp& op) { matrix(op.up_in_world); }
  void operator()(const SetStructure& op) {
    pose(op.structure->level_from_world);
    for (const FoundRoom& room : op.structure->rooms) {
      word(room.number);
      for (const PlaneId wall : room.walls) id(wall);
      for (const Eigen::Vector2d& corner : room.polygon) matrix(corner);
    }
    for (const FoundDoor& door : op.structure->doors) {
      matrix(door.position);
      number(door.width_m);
    }
    for (const FoundFloor& floor : op.structure->floors) matrix(floor.centroid);
    for (const Place& place : op.structure->places) matrix(place.position);
  }
  void operator()(const MoveStructureNodes& op) {
    for (const Eigen::Vector3d& node : op.rooms) matrix(node);
    for (const Eigen::Vector3d& node : op.floors) matrix(node);
  }

  void operator()(const OpenMap& op) {
    word(op.first.keyframe);
    word(op.first.landmark);
    word(op.first.plane);
    word(op.version);
  }
  void operator()(const AbsorbMap& op) {
    pose(op.world_from_other);
    op.other->keyframes().for_each([this](KeyframeId k, const Keyframe& keyframe) {
      id(k);
      pose(keyframe.world_from_camera);
    });
    op.other->landmarks().for_each([this](LandmarkId l, const Landmark& landmark) {
      id(l);
      matrix(landmark.point_in_world);
      word(landmark.observations.size());
    });
    op.other->planes().for_each([this](PlaneId p, const MappedPlane& mapped) {
      id(p);
      plane(mapped.plane);
      word(mapped.observations.size());
    });
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace

std::uint64_t MapEdit::hash() const {
  Fnv1a hash;
  hash.word(based_on);
  for (const EditOperation& operation : operations) {
    hash.word(operation.index());
    std::visit(hash, operation);
  }
  return hash.value();
}

}  // namespace vsgraphs
