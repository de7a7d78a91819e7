// Local mapping: turns keyframe requests into map, and keeps the neighbourhood of the newest keyframe at its
// optimum. Two steps per keyframe, each an edit of its own, so that tracking sees new landmarks before they are
// polished: `insert`, then `refine`. Holds no clock and no thread.
#pragma once

#include <functional>
#include <utility>

#include "core/base/options.h"
#include "core/base/trace.h"
#include "core/map/draft.h"
#include "core/map/stretch.h"
#include "core/mapping/culling.h"
#include "core/matching/messages.h"
#include "core/solve/window.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

struct LocalMapperOptions {
  int fusion_neighbours = 8;
  int triangulation_neighbours = 4;
  int window_keyframes = 25;
  int window_witnesses = 25;
  int iterations_before_dropping = 5;
  int iterations = 10;
  double stretch_way_m = usual_stretch_m;
  CullingOptions culling;
};

template <typename Visitor>
void describe(LocalMapperOptions& o, Visitor& field) {
  field("fusion_neighbours", o.fusion_neighbours, 1, 50,
        "number of neighbouring keyframes in which duplicates of new landmarks are sought");
  field("triangulation_neighbours", o.triangulation_neighbours, 0, 50,
        "number of neighbouring keyframes with which features without depth are triangulated");
  field("window_keyframes", o.window_keyframes, 2, 200,
        "number of keyframes whose poses one local adjustment changes");
  field("window_witnesses", o.window_witnesses, 1, 200,
        "number of fixed keyframes that anchor a local adjustment");
  field("iterations_before_dropping", o.iterations_before_dropping, 0, 50,
        "iterations of a local adjustment before outliers are dropped");
  field("iterations", o.iterations, 1, 50, "iterations of a local adjustment after outliers were dropped");
  field("stretch_way_m", o.stretch_way_m, 1.0, 100.0,
        "distance travelled, in metres, after which a new stretch of keyframes begins; a loop moves a "
        "stretch as a whole");
}

class LocalMapper {
 public:
  LocalMapper(const LocalMapperOptions& options, const Camera& camera, const ScalePyramid& pyramid,
              const FactorSwitches& factors = {});

  // Adds the requested keyframe with its observations and new landmarks. `keyframe` receives its id.
  MapEdit insert(const KeyframeRequest& request, const Snapshot& snapshot, KeyframeId& keyframe,
                 TraceSink* trace);

  // Adjusts the window around `keyframe` and culls. `stop` is asked between iterations; the number of iterations
  // done goes to `report`.
  MapEdit refine(KeyframeId keyframe, const Snapshot& snapshot, const std::function<bool()>& stop,
                 SolveReport& report, TraceSink* trace);

  // The young landmarks of a map, for the time that another one is worked on.
  struct Young {
    Probation probation;
    std::int64_t keyframe_count = 0;
  };
  Young put_away() { return {std::exchange(probation_, {}), keyframe_count_}; }
  void take_up(const Young& young) {
    probation_.take_up(young.probation, young.keyframe_count, keyframe_count_);
  }

 private:
  void take_over_observations(const KeyframeRequest& request, KeyframeId keyframe, Draft& draft);
  std::vector<KeyframeId> neighbours_of(const Map& map, KeyframeId keyframe, int count) const;
  void add_linked(const Map& map, KeyframeId keyframe, std::vector<KeyframeId>& candidates) const;
  void refresh_appearance(KeyframeId keyframe, Draft& draft) const;

  LocalMapperOptions options_;
  Camera camera_;
  ScalePyramid pyramid_;
  MeasurementModel model_;
  Probation probation_;
  std::int64_t keyframe_count_ = 0;
};

}  // namespace vsgraphs
