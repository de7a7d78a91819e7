// The one place where maps are written. Takes keyframe requests, has the stages work out edits, applies them and publishes a
// snapshot after each. Runs on one thread, whichever the executor gives it.
//
// One map is worked on; others lie dormant, never changed, each in a world of its own (they may come from a loaded atlas).
// Ids are disjoint over all of them. A request that starts a map puts the one before to sleep; one that is anchored to a
// keyframe of a dormant map wakes that one; a keyframe that shows a place of a dormant map joins the two.
#pragma once

#include <functional>

#include "core/loops/loop_adjustment.h"
#include "core/mapping/local_mapper.h"
#include "core/system/config/config.h"
#include "core/system/maps/followers.h"
#include "core/system/maps/map_listener.h"
#include "core/system/maps/markers.h"
#include "core/system/maps/schedule.h"
#include "core/system/maps/snapshot_cell.h"
#include "core/system/maps/span_recorder.h"
#include "core/system/maps/stage_guard.h"
#include "core/understanding/scene_builder.h"
#include "core/understanding/structure_builder.h"

namespace vsgraphs {

class MapOwner {
 public:
  // The last of `known` is worked on; maps without keyframes are none. `listener` may be null.
  MapOwner(const Config& config, const Camera& camera, SnapshotCell& cell, const AtlasState& known = {},
           std::shared_ptr<MapListener> listener = nullptr);

  // All that a keyframe brings about, in the order of the steps below; `stop_refining` is asked between iterations of the
  // window's adjustment. Afterwards adjustment() is what the executor has to run, here or beside. Once `stop` says so, what
  // takes long is left out: rooms and loops.
  void work_on(const KeyframeRequest& request, const std::function<bool()>& stop_refining,
               const std::function<bool()>& stop = {});
  // At the end of the run: the map this run made most of is the one given out, adjusted if that is still to be done, with its
  // rooms. Once `stop` says so, without what takes long: the adjustment, free space carved anew.
  void end_run(const std::function<bool()>& stop = {});

  // One step each: request -> keyframe in the map; its planes -> map; a late segmentation of a keyframe -> its planes
  // sought again; what was made of planes that were sought -> map; window around the keyframe inserted last -> adjusted. `stop` is asked between iterations.
  void insert(const KeyframeRequest& request);
  void find_planes();
  void interpret_planes();
  // After refine(): does the newest keyframe show a place mapped before? If so, close_loop() takes the drift since then
  // out and asks for the whole map to be adjusted.
  void look_for_loop();
  bool loop_found() const { return loop_.has_value(); }
  void close_loop();
  // Where no loop was found: or a place of a dormant map? Then join_maps() makes one of the two and asks for the same.
  void look_for_join();
  bool join_found() const { return join_.has_value(); }
  void join_maps();
  // The adjustment of the whole map to be run, any time and on any thread, while the steps above go on; null: none. It is
  // none once another map is worked on. When it has run, take_in_adjustment()
  // brings what it came to into the map as it is by then.
  const std::shared_ptr<FullAdjustment>& adjustment() const { return adjustment_; }
  // Here, on the owner's thread. False, and nothing to take in, where `stop` said so.
  bool run_adjustment(const std::function<bool()>& stop = {}) { return adjustment_->run(stop, &spans_); }
  // Runs and finishes what is to be adjusted, here, until nothing is or `stop` says so.
  void adjust_here(const std::function<bool()>& stop = {});
  void take_in_adjustment();
  // Has `work` do what the adjustment is to go on with. Where it throws there is no adjustment any more, now and later: false.
  bool adjust_guarded(const std::function<void()>& work);
  // With the rooms of the adjusted map.
  void finish_adjustment();
  // The part of insert() that makes the request's map the one worked on. False if it is already.
  bool choose_map(const KeyframeRequest& request);
  // The part of end_run() that does the same with the map this run made most of.
  bool settle();
  // Whether it is time to seek rooms again; `last`: at the end of the run.
  bool rooms_due() const { return !guard_.is_off("rooms") && structure_.due(newest_s_); }
  void find_rooms(bool last);
  // False, and nothing done, if the frame is no keyframe (any more) of the map worked on. interpret_planes() comes next.
  bool label(std::int64_t frame_index, const LabelGrid& labels);
  // Likewise for markers seen in its image.
  bool mark(std::int64_t frame_index, const MarkerDetections& detections);
  void refine(const std::function<bool()>& stop);

  std::uint64_t version() const { return map_.version(); }
  std::int64_t newest_frame() const { return newest_frame_; }  // that became a keyframe
  const std::vector<EditEvent>& edits() const { return edits_; }
  // All there are, the one worked on last, with a copy of what follows it; maps without keyframes are none.
  std::vector<MapState> maps() const;
  // One lane for mapping, one for scene understanding.
  std::vector<const SpanRecorder*> spans() const { return {&spans_, &scene_spans_}; }

 private:
  struct DormantMap {
    MapState state;
    int made = 0;  // keyframes of this run
    bool loaded = false;
    bool to_adjust = false;  // it was put to sleep before that was done
    LocalMapper::Young young = {};
  };
  struct FoundLoop {
    MapEdit edit;
  };
  struct FoundJoin {
    std::size_t dormant = 0;
    MapJoin join;
  };

  // `absorbed`: what followed the map that the edit takes in.
  void apply(const MapEdit& edit, EditEvent event, const Followers* absorbed = nullptr);
  void publish();
  void start_from(const AtlasState& known);
  Followers::Guard guarded();
  void warn();
  std::shared_ptr<const PlaceIndex> places() const;
  void seek_planes(KeyframeId keyframe, const LabelGrid* labels, EditEvent event);
  void work_on_map(const Map& map, Followers followers);
  void put_to_sleep();
  void drop_small_maps();
  void wake(std::size_t dormant, EditEvent::Kind why, std::int64_t frame);
  void open_new_map(std::int64_t frame);
  void publish_dormant();
  void tally(LoopTally& kind, const LoopReport& report, const Map& there);
  // `call` is given the listener, if there is one.
  template <typename Call>
  void tell(const Call& call) {
    if (listener_) guard_.run("listening to the map", [&] { call(*listener_); });
  }
  void tell_of_rooms(const Map& before);
  void adjust_from_here();
  void drop_adjustment();
  void note_moves(const MapEdit& loop);

  SystemOptions options_;
  std::shared_ptr<MapListener> listener_;
  StageGuard guard_;
  Map map_;
  Snapshot snapshot_;
  LocalMapper mapper_;
  SceneBuilder scene_;
  StructureBuilder structure_;
  LoopCloser loop_closer_;
  Followers new_followers_;  // of an empty map
  Followers followers_;
  KeyframeId looked_at_;  // whose planes were sought last
  int made_ = 0;          // keyframes of this run in the map worked on
  bool loaded_ = false;
  std::vector<DormantMap> dormant_;  // oldest first
  std::shared_ptr<const std::vector<MapState>> published_dormant_;
  std::optional<FoundLoop> loop_;
  std::optional<FoundJoin> join_;
  std::shared_ptr<FullAdjustment> adjustment_;
  std::vector<Se3> moved_since_adjustment_;  // by loops; world from world, by keyframe index
  bool adjust_again_ = false;                // a loop was closed while one was under way
  std::optional<std::int64_t> completed_before_adjustment_;
  AtlasCounts counts_;
  LoopTallies tallies_;
  std::shared_ptr<const LoopTallies> published_tallies_;
  MeasurementModel model_;
  SnapshotCell& cell_;
  SpanRecorder spans_, scene_spans_;
  KeyframeId newest_;
  std::int64_t newest_frame_ = 0;
  double newest_s_ = 0;
  std::int64_t inserted_ = 0, completed_ = 0;
  std::vector<EditEvent> edits_;
};

}  // namespace vsgraphs
