// The map: values in tables, and nothing that has no place in a saved file. One owner writes it, through
// `apply` alone; everybody else holds a `Snapshot`. Copying a map shares its storage (see table.h).
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/map/edit.h"
#include "core/map/keyframe.h"
#include "core/map/landmark.h"
#include "core/map/mapped_plane.h"
#include "core/map/marker.h"
#include "core/map/structure.h"
#include "core/map/table.h"

namespace vsgraphs {

class Map;
using Snapshot = std::shared_ptr<const Map>;

class Map {
 public:
  // Small chunks for heavy values, large chunks for light ones: a copy-on-write clones a whole chunk.
  using Keyframes = Table<KeyframeId, Keyframe, 8, false>;
  using Landmarks = Table<LandmarkId, Landmark, 64>;
  using Planes = Table<PlaneId, MappedPlane, 8>;
  using RetiredKeyframes = Table<KeyframeId, RetiredKeyframe, 32, false>;

  const Keyframes& keyframes() const { return keyframes_; }
  const Landmarks& landmarks() const { return landmarks_; }
  const Planes& planes() const { return planes_; }
  const Markers& markers() const { return markers_; }
  // An entry for every keyframe there ever was; without an anchor while it lives.
  const RetiredKeyframes& retired_keyframes() const { return retired_; }
  // Unit vector against gravity; empty until ground and walls have agreed on it.
  const std::optional<Eigen::Vector3d>& up_in_world() const { return up_in_world_; }
  // Empty before rooms are sought.
  const FoundStructure& structure() const { return *structure_; }
  // Of all classes that a segmenter named here.
  const ClassNames& class_names() const { return *class_names_; }
  std::uint64_t version() const { return version_; }
  // Behind every id that was ever in use here; a multiple of the tables' chunks.
  FirstIds unused_ids() const;

  // World pose of something anchored to a keyframe, culled or not; empty if the anchor never existed.
  std::optional<Se3> resolve(const AnchoredPose& pose) const;
  // A keyframe's tracked link to a living keyframe. Where the link's target was culled, the link is continued to the keyframe that the
  // target is anchored to, and its information is divided by the number of such steps plus one. Empty if the keyframe has no link, or
  // would be linked to itself.
  std::optional<TrackedLink> living_link(KeyframeId id) const;
  // The living keyframe that stands for `pose`'s anchor now, and the pose relative to it.
  std::optional<AnchoredPose> reanchor(AnchoredPose pose) const;

  // The keyframe that was made of a frame; an invalid id if there is none. Newest first: cheap for recent frames.
  KeyframeId keyframe_of_frame(std::int64_t frame_index) const;

  // The stretch a keyframe belongs to, living or retired (stretch.h), named by its first keyframe; invalid if it never existed.
  KeyframeId stretch_of(KeyframeId id) const;

  // The room a point of the world is in; no_room outside all that were found.
  RoomNumber room_at(const Eigen::Vector3d& point_in_world) const;

  // The patches of a keyframe, living or retired; null if it has none.
  const std::shared_ptr<const KeyframeSurfaces>& patches_of(KeyframeId id) const;
  // The patch behind an observation, whether its keyframe lives or is retired; nullptr if there is none.
  const SurfacePatch* patch(const PlaneObservation& observation) const;

  // Mean of the middles of the plane's patches, world; its anchor if there are none. Of at most some hundred of them, evenly spread
  // over all: what it costs does not grow.
  Eigen::Vector3d observed_centre(const MappedPlane& plane) const;

  // Where the marker's observations say it hangs. Linear in them.
  MarkerSightings sightings(const MappedMarker& marker) const;

  // Keyframes that share at least `min_shared` landmarks with `id`, most shared first (ties: lower id first).
  // Cost: one visit per observation of the keyframe's landmarks.
  std::vector<std::pair<KeyframeId, int>> covisible(KeyframeId id, int min_shared) const;

  // Does one operation. What refers to ids that have vanished since does nothing.
  void apply(const EditOperation& operation);
  // Does all of an edit's operations in order and counts one version up.
  void apply(const MapEdit& edit);

  // Every part of the map under a name, as visit(name, part) or visit(name, part, since): what an archive holds, and from which
  // format of atlases on. A new table is named here.
  template <FieldsOf<Map> T>
  friend void visit_tables(T& map, auto&& visit) {
    visit("keyframes", map.keyframes_);
    visit("retired_keyframes", map.retired_);
    visit("landmarks", map.landmarks_);
    visit("planes", map.planes_);
    visit("markers", map.markers_);
    visit("up_in_world", map.up_in_world_);
    FoundStructure structure = *map.structure_;
    visit("structure", structure);
    ClassNames names = *map.class_names_;
    visit("class_names", names, 5);
    if constexpr (!std::is_const_v<T>) {
      map.structure_ = std::make_shared<const FoundStructure>(std::move(structure));
      map.class_names_ = std::make_shared<const ClassNames>(std::move(names));
    }
    visit("version", map.version_);
  }

  // For maps of a file that knows no stretches: cuts them by their way.
  void cut_into_stretches(double max_way_m);

  // A copy that nobody writes; the map goes on in fresh chunks. Only the owner may call this.
  Snapshot snapshot();

 private:
  void apply_one(const AddKeyframe& op);
  void apply_one(const RemoveKeyframe& op);
  void apply_one(const AddLandmark& op);
  void apply_one(const RemoveLandmark& op);
  void apply_one(const MergeLandmark& op);
  void apply_one(const AddObservation& op);
  void apply_one(const RemoveObservation& op);
  void apply_one(const MoveKeyframe& op);
  void apply_one(const SetOdometry& op);
  void apply_one(const MoveLandmark& op);
  void apply_one(const SetAppearance& op);
  void apply_one(const CountSightings& op);
  void apply_one(const SetPatches& op);
  void apply_one(const AddPlane& op);
  void apply_one(const RemovePlane& op);
  void apply_one(const MergePlane& op);
  void apply_one(const AddPlaneObservation& op);
  void apply_one(const RemovePlaneObservation& op);
  void apply_one(const MovePlane& op);
  void apply_one(const ClassifyPlane& op);
  void apply_one(const PairFaces& op);
  void apply_one(const SetUp& op);
  void apply_one(const SetStructure& op);
  void apply_one(const MoveStructureNodes& op);
  void apply_one(const AddMarker& op);
  void apply_one(const RemoveMarker& op);
  void apply_one(const AddMarkerObservation& op);
  void apply_one(const RemoveMarkerObservations& op);
  void apply_one(const MoveMarker& op);
  void apply_one(const NameClasses& op);
  void apply_one(const SetClasses& op);
  void apply_one(const SetPlaneClasses& op);
  void apply_one(const OpenMap& op);
  void apply_one(const AbsorbMap& op);
  void absorb_markers(const Map& other, const Se3& world_from_other);
  // Rooms and floors that used a plane use what it was merged into, or do without it.
  void relink_structure(PlaneId gone, PlaneId into);
  // Steps that begin at a keyframe which is about to go begin where its own does, if it has one.
  void pass_on_steps(KeyframeId gone);
  void detach(LandmarkId landmark, const Observation& observation);

  Keyframes keyframes_;
  Landmarks landmarks_;
  Planes planes_;
  Markers markers_;
  RetiredKeyframes retired_;
  std::optional<Eigen::Vector3d> up_in_world_;
  std::shared_ptr<const FoundStructure> structure_ = std::make_shared<const FoundStructure>();
  std::shared_ptr<const ClassNames> class_names_ = std::make_shared<const ClassNames>();
  std::uint64_t version_ = 0;
};

}  // namespace vsgraphs
