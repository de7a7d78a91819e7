// Taking out what does not earn its place: landmarks that are not found again and keyframes that show nothing new.
// Rules after ORB-SLAM (Mur-Artal, Montiel, Tardos, T-RO 2015, sections VI-B and VI-E).
#pragma once

#include <deque>
#include <vector>

#include "core/base/options.h"
#include "core/map/draft.h"

namespace vsgraphs {

struct CullingOptions {
  double min_found_share = 0.25;
  int probation_keyframes = 3;
  int min_observations = 2;
  double redundant_share = 0.9;
  int redundant_witnesses = 3;
  int revisit_gap_keyframes = 10;
  double revisit_m = 0.25;
  double revisit_rad = 0.25;
  double revisit_share = 0.6;
};

template <typename Visitor>
void describe(CullingOptions& o, Visitor& field) {
  field("min_found_share", o.min_found_share, 0.0, 1.0,
        "a young landmark found in less than this share of the frames that should show it is removed");
  field("probation_keyframes", o.probation_keyframes, 2, 20,
        "number of keyframes for which a new landmark counts as young");
  field("min_observations", o.min_observations, 1, 10,
        "a landmark observed by fewer keyframes than this when it is no longer young is removed");
  field("redundant_share", o.redundant_share, 0.5, 1.0,
        "a keyframe is removed if enough other keyframes observe this share of its landmarks as well");
  field("redundant_witnesses", o.redundant_witnesses, 1, 10,
        "number of other keyframes that must observe a landmark for redundant_share to count it");
  field(
      "revisit_gap_keyframes", o.revisit_gap_keyframes, 1, 1000,
      "a keyframe counts as a revisit if one that is older by this many keyframes stands at the same place");
  field("revisit_m", o.revisit_m, 0.0, 5.0,
        "two keyframes closer than this, in metres, stand at the same place (see revisit_gap_keyframes)");
  field("revisit_rad", o.revisit_rad, 0.0, 3.2,
        "two keyframes turned by less than this, in radians, look the same way (see revisit_gap_keyframes)");
  field("revisit_share", o.revisit_share, 0.0, 1.0,
        "a revisit is removed if other keyframes, one of them older, observe this share of its landmarks as "
        "well");
}

// Landmarks on probation, with the number of keyframes made since their birth.
class Probation {
 public:
  void admit(const std::vector<LandmarkId>& landmarks, std::int64_t keyframe_count);
  // Removes those that failed, releases those that passed.
  void judge(const CullingOptions& options, std::int64_t keyframe_count, Draft& draft);
  // Those of another map on top, which were as old by its `their_count` as they are by `keyframe_count` from now on.
  void take_up(const Probation& others, std::int64_t their_count, std::int64_t keyframe_count);

 private:
  struct Entry {
    LandmarkId landmark;
    std::int64_t born;  // keyframe count
  };
  std::deque<Entry> entries_;
};

// Removes the redundant keyframes among `candidates`; never the map's first. One that was made by coming back goes sooner,
// tracked link or not, and takes along what it saw of planes that enough others see: walking the same rooms again and
// again must not make the map grow. What was anchored to it, links included, is anchored to a neighbour from then on.
// Cost: one visit per observation of a candidate's landmarks, and one per keyframe of the map for each that may go.
void cull_keyframes(const CullingOptions& options, const std::vector<KeyframeId>& candidates, Draft& draft);

}  // namespace vsgraphs
