// Scene understanding: sees the planes of a keyframe, says which mapped ones they are, what those are (wall, ground, ...),
// and which way is up. It proposes and never optimises: the next window turns proposals into factors.
// After vS-Graphs, "Building Component Recognition".
#pragma once

#include <set>
#include <vector>

#include "core/base/trace.h"
#include "core/geometry/camera.h"
#include "core/map/draft.h"
#include "core/map/label_grid.h"
#include "core/scene/surfaces/plane_association.h"
#include "core/scene/surfaces/plane_extraction.h"
#include "core/scene/surfaces/plane_role.h"
#include "core/scene/surfaces/surface_keeper.h"

namespace vsgraphs {

struct SceneBuilderOptions {
  double geometry_votes = 1.5;
  double accepted_votes = 1.0;
  double min_new_plane_area_m2 = 0.15;
  double max_behind_m = 0.1;
  PlaneExtractionOptions extraction;
  PlaneAssociationOptions association;
  PlaneRoleOptions role;
};

template <typename Visitor>
void describe(SceneBuilderOptions& o, Visitor& field) {
  field("geometry_votes", o.geometry_votes, 0.0, 100.0,
        "weight of geometry's vote on a plane's class; a segmenter has one vote per keyframe and plane");
  field("accepted_votes", o.accepted_votes, 0.0, 100.0, "number of votes that a class needs to be accepted");
  field("min_new_plane_area_m2", o.min_new_plane_area_m2, 0.0, 10.0,
        "smallest patch that starts a new plane, in square metres");
  field("max_behind_m", o.max_behind_m, 0.0, 10.0,
        "a landmark farther than this, in metres, behind a wall or ground that hides it is removed");
}

// Two edits per keyframe: what it sees is associated with the planes; then, when that is known (SurfaceKeeper), the planes
// around are interpreted. Holds nothing itself.
class SceneBuilder {
 public:
  SceneBuilder(const SceneBuilderOptions& options, const Camera& camera)
      : options_(options), camera_(camera) {}

  // The planes of a keyframe that is in the map, and which way is up. With `labels` (may be null) of an image seen before:
  // looks at it again. `surfaces` knows the snapshot's planes. A few ms.
  MapEdit associate(KeyframeId keyframe, const Snapshot& snapshot, const SurfaceKeeper& surfaces,
                    const LabelGrid* labels, TraceSink* trace) const;
  // Planes that turn out to be one, what those are that changed and their neighbours, what the keyframe cannot have seen.
  // Nothing before it is known which way is up.
  MapEdit interpret(KeyframeId keyframe, const Snapshot& snapshot, const SurfaceKeeper& surfaces,
                    TraceSink* trace) const;

 private:
  void find_up_direction(const SurfaceKeeper& surfaces, Draft& draft) const;
  static std::vector<PlaneId> around(const std::set<PlaneId>& changed, const SurfaceKeeper& surfaces,
                                     const Map& map);
  struct Stances {
    std::vector<PlaneId> level, upright;
  };
  static Stances by_stance(const std::set<PlaneId>& planes, const Map& map);
  // Says which are something else now.
  std::set<PlaneId> classify(const std::vector<PlaneId>& planes, const SurfaceKeeper& surfaces,
                             Draft& draft) const;
  static void call_planes(const SurfaceKeeper& surfaces, Draft& draft);
  static void keep_classes(KeyframeId id, const LabelGrid& labels, Draft& draft);
  SurfaceRole judge(const Map& map, const SurfaceKeeper& surfaces, PlaneId id, RoleVotes& votes) const;
  bool another_is_the_wall(const Map& map, const SurfaceKeeper& surfaces, PlaneId id) const;
  static SurfaceFacts facts_of(const Map& map, const MappedPlane& plane, const KnownSurface& known,
                               const StretchPoses& stretches);
  void pair_faces(const std::vector<PlaneId>& candidates, const SurfaceKeeper& surfaces, Draft& draft) const;
  void remove_hidden_landmarks(KeyframeId keyframe, const SurfaceKeeper& surfaces, Draft& draft) const;

  SceneBuilderOptions options_;
  Camera camera_;
};

}  // namespace vsgraphs
