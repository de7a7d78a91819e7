// Loop closing: recognises that a keyframe shows a place mapped before, makes sure of it, and works out the edit that brings
// both sights together. One verb, synchronous; holds no clock and no thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/base/trace.h"
#include "core/loops/loop_alignment.h"
#include "core/loops/loop_checks.h"
#include "core/loops/loop_correction.h"
#include "core/loops/loop_graph.h"
#include "core/map/map.h"
#include "core/matching/messages.h"
#include "core/vision/place_index.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

struct LoopCloserOptions {
  int min_gap_keyframes = 10;
  int max_candidates = 5;
  double min_score = 0.003;
  int pause_keyframes = 3;
  int place_keyframes = 10;
  int neighbours = 5;
  LoopAlignmentOptions alignment;
  LoopCheckOptions checks;
  DriftOptions drift;
  LoopCorrectionOptions correction;
};

template <typename Visitor>
void describe(LoopCloserOptions& o, Visitor& field) {
  field("min_gap_keyframes", o.min_gap_keyframes, 1, 1000,
        "smallest number of keyframes between the two ends of a loop");
  field("max_candidates", o.max_candidates, 1, 20,
        "number of similar places that each keyframe is compared with");
  field("min_score", o.min_score, 0.0, 1.0,
        "lowest similarity, 0 to 1, at which the place index counts a place as recognised");
  field("pause_keyframes", o.pause_keyframes, 0, 100,
        "number of keyframes after a loop that look for no other loop");
  field("place_keyframes", o.place_keyframes, 1, 50,
        "number of neighbouring keyframes that make up one end of a loop");
  field("neighbours", o.neighbours, 1, 20,
        "number of neighbours of a keyframe that are asked whether they confirm its loop");
}

// How far a candidate came; the checks in the order they are made.
enum class LoopVerdict : std::uint8_t {
  none_similar,         // no place worth comparing
  not_aligned,          // too few features agree on a pose
  unsupported,          // the keyframe's neighbours do not see the place
  tilted,               // it would tilt the up direction
  surfaces_disagree,    // walls or ground would not fall together
  through_walls,        // surfaces would stand where the other side looked through
  neighbours_disagree,  // so would the surroundings of the two places, which would become one map
  beyond_drift,         // the map cannot have drifted that far
  joined,               // closed; only landmarks and planes were merged, as nothing was off
  closed,               // closed and corrected
};
inline constexpr std::size_t loop_verdict_count = 10;
const char* to_string(LoopVerdict verdict);

struct LoopReport {
  LoopVerdict verdict = LoopVerdict::none_similar;  // of the candidate that came furthest
  KeyframeId keyframe, place;
  double score = 0;    // in the place index
  int inliers = 0;     // landmarks of the place that the keyframe sees
  int supporters = 0;  // neighbours that see it too
  SurfaceAgreement surfaces;
  FreeSpaceCount free_space;
  FreeSpaceCount neighbours;  // of the two maps, at most 60 keyframes of each
  double drift_sigmas = 0;
  double off_m = 0, off_rad = 0;  // what was corrected, at the keyframe
  SolveReport pose_graph;
  std::array<int, loop_verdict_count> attempts{};  // candidates of this call, by their verdicts
};

// Two maps become one. `edit` is of the older one, whose world stays: it opens that map, where it is not the one being worked
// on, and takes the younger one in.
struct MapJoin {
  bool onto_other = false;  // the older one is the other one
  Se3 older_from_younger;
  MapEdit edit;
};

class LoopCloser {
 public:
  LoopCloser(const LoopCloserOptions& options, const Camera& camera, const ScalePyramid& pyramid,
             std::uint64_t seed);

  // Whether `keyframe`, which is in the snapshot, closes a loop, and the edit if it does. `places` holds the snapshot's
  // keyframes (PlaceKeeper). Cost: some ms where nothing is similar; about 20 ms per candidate; up to a second once for a
  // closed loop in a map of thousands of keyframes.
  std::optional<MapEdit> close(KeyframeId keyframe, const Snapshot& snapshot, const PlaceIndex& places,
                               LoopReport& report, TraceSink* trace);

  // Whether `keyframe`, which is in the snapshot being worked on, shows a place of another map: the same checks, but for
  // the drift, of which there is none to be known between maps; in its stead all that surrounds the two places must not
  // contradict. Cost: as above, one visit per chunk of both maps, and up to 0.3 s per place that passes all else.
  std::optional<MapJoin> join(KeyframeId keyframe, const Snapshot& snapshot, const KnownMap& other,
                              LoopReport& report, TraceSink* trace);

 private:
  struct Candidate {
    KeyframeId keyframe;
    double score = 0;
  };
  std::vector<Candidate> candidates(const Map& map, const FeatureSet& features, const PlaceIndex& places,
                                    std::span<const std::uint8_t> excluded) const;
  // `up_here`: up as the map of `here` has it, while both maps stand unaligned in one table.
  static void note(const LoopReport& attempt, LoopReport& report);
  std::optional<LoopAlignment> verify(const Map& map, const MappedPlace& here, const MappedPlace& there,
                                      const std::optional<Eigen::Vector3d>& up_here,
                                      const std::optional<Eigen::Vector3d>& up_there,
                                      LoopReport& report) const;
  bool surfaces_pass(const Map& map, const MappedPlace& here, const MappedPlace& there, const Se3& correction,
                     LoopReport& report) const;
  // Of `ours`, moved onto the other one.
  bool neighbours_pass(const Map& both, const Snapshot& ours, const Snapshot& theirs,
                       const LoopAlignment& loop, LoopReport& report) const;
  bool drift_passes(const Map& map, const KeyframeGraph& graph, const MappedPlace& there,
                    const LoopAlignment& loop, LoopReport& report) const;
  MapEdit correct(const Snapshot& snapshot, const KeyframeGraph& graph, const MappedPlace& here,
                  const MappedPlace& there, const LoopAlignment& loop, LoopReport& report) const;
  MapJoin join_maps(const Snapshot& snapshot, const Snapshot& other, const MappedPlace& here,
                    const MappedPlace& there, const LoopAlignment& loop) const;
  void merge_duplicates(const MappedPlace& here, const MappedPlace& there, const LoopAlignment& loop,
                        Draft& draft) const;

  LoopCloserOptions options_;
  Camera camera_;
  ScalePyramid pyramid_;
  LoopAligner aligner_;
  std::uint64_t seed_;
  std::optional<KeyframeId> last_closed_;
};

}  // namespace vsgraphs
