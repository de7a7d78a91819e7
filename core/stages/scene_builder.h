// Scene understanding: sees the planes of a keyframe, says which mapped ones they are, what those are (wall, ground, ...),
// and which way is up. It proposes and never optimises: the next window turns proposals into factors.
// After vS-Graphs, "Building Component Recognition".
#pragma once

#include <map>
#include <set>

#include "core/base/trace.h"
#include "core/geometry/camera.h"
#include "core/map/draft.h"
#include "core/map/label_grid.h"
#include "core/scene/plane_association.h"
#include "core/scene/plane_evidence.h"
#include "core/scene/plane_extraction.h"
#include "core/scene/plane_role.h"

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
        "what geometry's opinion of a plane's class weighs; a segmenter has one vote per keyframe and plane");
  field("accepted_votes", o.accepted_votes, 0.0, 100.0, "votes a class needs to be accepted");
  field("min_new_plane_area_m2", o.min_new_plane_area_m2, 0.0, 10.0, "a smaller patch starts no new plane");
  field("max_behind_m", o.max_behind_m, 0.0, 10.0,
        "a landmark farther than this behind a wall or the ground that hides it is removed");
}

class SceneBuilder {
 public:
  SceneBuilder(const SceneBuilderOptions& options, const Camera& camera)
      : options_(options), camera_(camera) {}

  // The planes of a keyframe that is in the map, and all that follows from them. With `labels` (may be null) of an
  // image seen before: looks at it again. A few ms.
  MapEdit propose(KeyframeId keyframe, const Snapshot& snapshot, const LabelGrid* labels, TraceSink* trace);

  // Gathers what the rays of a map's keyframes say about its planes, where nobody has yet: the map was loaded. Cost: some
  // tens of us per pair of keyframe and plane, once.
  void recall(const Map& map);
  // A map was joined with another: its planes were moved by `change` (world from world), and the next proposal looks for
  // planes to merge among all.
  void move(const Map& map, const Se3& change);
  // `gone` was merged into `kept` by somebody else.
  void note_merge(PlaneId gone, PlaneId kept);

 private:
  std::vector<PlaneId> associate(KeyframeId keyframe, const LabelGrid* labels, Draft& draft,
                                 TraceSink* trace);
  void merge(const std::vector<PlaneId>& touched, Draft& draft);
  void find_up_direction(Draft& draft) const;
  void gather_evidence(KeyframeId keyframe, const Map& map);
  void classify(const std::vector<PlaneId>& candidates, Draft& draft) const;
  static RoleVotes segmenter_votes(const Map& map, const MappedPlane& plane);
  bool another_is_the_wall(const Map& map, PlaneId id) const;
  SurfaceFacts facts_of(const Map& map, const MappedPlane& plane) const;
  void pair_faces(const std::vector<PlaneId>& touched, Draft& draft) const;
  void remove_hidden_landmarks(KeyframeId keyframe, Draft& draft) const;

  SceneBuilderOptions options_;
  Camera camera_;
  std::map<PlaneId, PlaneEvidence> evidence_;  // once it is known which way is up
  std::set<KeyframeId> told_;                  // keyframes whose rays are in it
  bool merges_all_ = false;                    // maps were joined since the last proposal
};

}  // namespace vsgraphs
