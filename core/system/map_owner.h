// The one place where the map is written. Takes keyframe requests, has the mapper work out edits, applies them and
// publishes a snapshot after each. Runs on one thread, whichever the executor gives it.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>

#include "core/stages/local_mapper.h"
#include "core/stages/scene_builder.h"
#include "core/stages/structure_builder.h"
#include "core/system/config.h"
#include "core/system/schedule.h"
#include "core/system/span_recorder.h"

namespace vsgraphs {

// The newest snapshot, for any thread to take.
class SnapshotCell {
 public:
  struct Content {
    Snapshot snapshot;
    std::int64_t inserted = 0;  // keyframe requests that are in the snapshot
    std::shared_ptr<const PlaceIndex> places;  // of the snapshot's keyframes
  };
  void publish(Content content);
  Content take() const;
  // Waits until at least `count` requests are in, or the cell is closed.
  void wait_for_inserted(std::int64_t count) const;
  // Ends all waiting, now and later.
  void close();

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Content content_;
  bool closed_ = false;
};

class MapOwner {
 public:
  MapOwner(const Config& config, const Camera& camera, SnapshotCell& cell);

  // One step each: request -> keyframe in the map; its planes -> map; a late segmentation of a keyframe -> its planes
  // sought again; window around the keyframe inserted last -> adjusted. `stop` is asked between iterations.
  void insert(const KeyframeRequest& request);
  void find_planes();
  // After refine(): does the newest keyframe show a place mapped before? If so, close_loop() takes the drift since then
  // out, and adjust_all() brings the whole map to its optimum.
  void look_for_loop();
  bool loop_found() const { return loop_edit_.has_value(); }
  void close_loop();
  void adjust_all(const std::function<bool()>& stop);
  // Loops closed so far.
  int loops() const { return loops_; }
  // Whether it is time to seek rooms again; `last`: at the end of the run.
  bool rooms_due() const { return structure_.due(newest_s_); }
  void find_rooms(bool last);
  // False, and nothing done, if the frame is no keyframe (any more).
  bool label(std::int64_t frame_index, const LabelGrid& labels);
  void refine(const std::function<bool()>& stop);

  std::uint64_t version() const { return map_.version(); }
  const std::vector<EditEvent>& edits() const { return edits_; }
  // One lane for mapping, one for scene understanding.
  std::vector<const SpanRecorder*> spans() const { return {&spans_, &scene_spans_}; }

 private:
  void apply(const MapEdit& edit, EditEvent event);
  void publish();

  Map map_;
  Snapshot snapshot_;
  LocalMapper mapper_;
  SceneBuilder scene_;
  StructureBuilder structure_;
  LoopCloser loop_closer_;
  PlaceIndex places_;
  std::shared_ptr<const PlaceIndex> published_places_;
  std::optional<MapEdit> loop_edit_;
  int loops_ = 0;
  MeasurementModel model_;
  bool closes_loops_;
  SnapshotCell& cell_;
  SpanRecorder spans_, scene_spans_;
  KeyframeId newest_;
  std::int64_t newest_frame_ = 0;
  double newest_s_ = 0;
  std::int64_t inserted_ = 0;
  std::vector<EditEvent> edits_;
};

}  // namespace vsgraphs
