#include "core/system/maps/map_owner.h"

#include <utility>

#include "core/base/check.h"
#include "core/loops/loop_rebase.h"

namespace vsgraphs {

namespace {

constexpr char adjustment_name[] = "adjustment of the whole map";

}  // namespace

MapOwner::MapOwner(const Config& config, const Camera& camera, SnapshotCell& cell, const AtlasState& known,
                   std::shared_ptr<MapListener> listener)
    : options_(config.system),
      listener_(std::move(listener)),
      guard_(config.system.stop_on_fault),
      snapshot_(map_.snapshot()),
      mapper_(config.mapper, camera, config.orb.pyramid(), config.factors),
      scene_(config.scene, camera),
      structure_(config.structure),
      loop_closer_(config.loop, camera, config.orb.pyramid(), static_cast<std::uint64_t>(config.system.seed)),
      new_followers_(make_followers(config, camera)),
      followers_(new_followers_.copy()),
      model_{camera, config.orb.pyramid().factor, config.factors},
      cell_(cell),
      spans_("local mapping"),
      scene_spans_("scene understanding") {
  start_from(known);
  publish();
}

void MapOwner::work_on(const KeyframeRequest& request, const std::function<bool()>& stop_refining,
                       const std::function<bool()>& stop) {
  const auto go_on = [&stop] { return !stop || !stop(); };
  insert(request);
  if (options_.builds_scene()) {
    find_planes();
    interpret_planes();
  }
  if (options_.builds_structure() && rooms_due() && go_on()) find_rooms(false);
  refine(stop_refining);
  if (go_on()) look_for_loop();
  if (loop_found()) {
    close_loop();
  } else if (go_on()) {
    look_for_join();
    if (join_found()) join_maps();
  }
  ++completed_;
  publish();
}

void MapOwner::end_run(const std::function<bool()>& stop) {
  if (inserted_ == 0) return;
  settle();
  adjust_here(stop);
  const bool stopped = stop && stop();
  counts_.unadjusted = adjustment_ != nullptr;
  if (stopped) drop_adjustment();
  if (options_.builds_structure()) find_rooms(!stopped);
  publish();
}

void MapOwner::insert(const KeyframeRequest& request) {
  choose_map(request);
  spans_.set_frame(request.frame_index);
  const MapEdit edit = mapper_.insert(request, snapshot_, newest_, &spans_);
  newest_frame_ = request.frame_index;
  newest_s_ = request.timestamp_s;
  ++inserted_;
  ++made_;
  apply(edit, {EditEvent::Kind::insert, request.frame_index, 0, 0});
  tell([this](MapListener& listener) { listener.keyframe_made(newest_, snapshot_); });
}

void MapOwner::find_planes() {
  seek_planes(newest_, nullptr, {EditEvent::Kind::planes, newest_frame_, 0, 0});
}

bool MapOwner::label(std::int64_t frame_index, const LabelGrid& labels) {
  looked_at_ = {};
  const KeyframeId labelled = map_.keyframe_of_frame(frame_index);
  if (labelled.valid()) seek_planes(labelled, &labels, {EditEvent::Kind::labels, frame_index, 0, 0});
  return looked_at_.valid();
}

void MapOwner::seek_planes(KeyframeId keyframe, const LabelGrid* labels, EditEvent event) {
  scene_spans_.set_frame(event.frame);
  looked_at_ = {};
  MapEdit edit;
  const bool found = guard_.run("planes", [&] {
    const Span span(&scene_spans_, labels ? "label_planes" : "find_planes");
    edit = scene_.associate(keyframe, snapshot_, *followers_.find<SurfaceKeeper>(), labels, &scene_spans_);
  });
  if (!found) return;
  apply(edit, event);
  looked_at_ = keyframe;
}

void MapOwner::interpret_planes() {
  if (!looked_at_.valid()) return;
  MapEdit edit;
  const bool done = guard_.run("planes", [&] {
    edit = scene_.interpret(looked_at_, snapshot_, *followers_.find<SurfaceKeeper>(), &scene_spans_);
  });
  looked_at_ = {};
  if (done) apply(edit, {EditEvent::Kind::roles, newest_frame_, 0, 0});
}

bool MapOwner::mark(std::int64_t frame_index, const MarkerDetections& detections) {
  const KeyframeId seeing = map_.keyframe_of_frame(frame_index);
  if (!seeing.valid()) return false;
  scene_spans_.set_frame(frame_index);
  MapEdit edit;
  const bool placed = guard_.run("markers", [&] {
    const Span span(&scene_spans_, "place_markers");
    edit = place_markers(seeing, detections, snapshot_);
  });
  if (!placed) return false;
  apply(edit, {EditEvent::Kind::markers, frame_index, 0, 0});
  return true;
}

void MapOwner::look_for_loop() {
  loop_.reset();
  if (!options_.loop_closing || !map_.keyframes().contains(newest_)) return;
  const Span span(&spans_, "look_for_loop");
  guard_.run("loops", [&] {
    LoopReport report;
    if (auto edit = loop_closer_.close(newest_, snapshot_, *places(), report, &spans_))
      loop_ = FoundLoop{std::move(*edit)};
    tally(tallies_.loops, report, *snapshot_);
  });
}

void MapOwner::tally(LoopTally& kind, const LoopReport& report, const Map& there) {
  kind.add(report, *snapshot_, there);
  published_tallies_ = std::make_shared<const LoopTallies>(tallies_);
  if (!report.place.valid()) return;
  const bool accepted = report.verdict == LoopVerdict::closed || report.verdict == LoopVerdict::joined;
  const LoopDecision decision{report, accepted, &kind == &tallies_.joins};
  tell([&](MapListener& listener) { listener.loop_decided(decision, snapshot_); });
}

void MapOwner::close_loop() {
  VSG_INVARIANT(loop_.has_value());
  ++counts_.loops;
  if (adjustment_) note_moves(loop_->edit);
  apply(loop_->edit, {EditEvent::Kind::loop, newest_frame_, 0, 0});
  loop_.reset();
  adjust_from_here();
}

// What the adjustment under way will have to follow.
void MapOwner::note_moves(const MapEdit& loop) {
  moved_since_adjustment_.resize(map_.keyframes().index_bound());
  for (const EditOperation& operation : loop.operations) {
    const auto* move = std::get_if<MoveKeyframe>(&operation);
    const Keyframe* keyframe = move ? map_.keyframes().find(move->id) : nullptr;
    if (!keyframe) continue;
    Se3& moved = moved_since_adjustment_[move->id.index];
    moved = (move->world_from_camera * keyframe->world_from_camera.inverse() * moved).normalized();
  }
}

// One that is under way is let come to its end: where loop follows loop none ever would.
void MapOwner::adjust_from_here() {
  if (guard_.is_off(adjustment_name)) return;
  adjust_again_ = adjustment_ != nullptr;
  if (adjust_again_) return;
  adjustment_ = std::make_shared<FullAdjustment>(snapshot_, model_);
  moved_since_adjustment_.clear();
  if (!completed_before_adjustment_) completed_before_adjustment_ = completed_;
}

void MapOwner::drop_adjustment() {
  adjustment_.reset();
  adjust_again_ = false;
  completed_before_adjustment_.reset();
}

void MapOwner::adjust_here(const std::function<bool()>& stop) {
  while (adjustment_ && !(stop && stop())) {
    bool ended = false;
    const bool held = adjust_guarded([&] { ended = run_adjustment(stop); });
    if (held && !ended) return;
    if (held) finish_adjustment();
  }
}

bool MapOwner::adjust_guarded(const std::function<void()>& work) {
  if (guard_.run(adjustment_name, work)) return true;
  drop_adjustment();
  publish();
  return false;
}

void MapOwner::take_in_adjustment() {
  VSG_INVARIANT(adjustment_ != nullptr);
  const std::shared_ptr<FullAdjustment> done = std::exchange(adjustment_, nullptr);
  MapEdit edit;
  const bool rebased = adjust_guarded([&] {
    const Span span(&spans_, "rebase_adjustment");
    edit = rebase(done->edit(), done->base(), *snapshot_, moved_since_adjustment_);
  });
  if (!rebased) return;
  apply(edit, {EditEvent::Kind::adjust, newest_frame_, done->iterations(), 0});
  if (adjust_again_) adjust_from_here();
}

void MapOwner::finish_adjustment() {
  take_in_adjustment();
  if (options_.builds_structure()) find_rooms(false);
  if (adjustment_) return;
  completed_before_adjustment_.reset();
  publish();
}

void MapOwner::find_rooms(bool last) {
  scene_spans_.set_frame(newest_frame_);
  {
    const Span span(&scene_spans_, "follow_map");
    followers_.catch_up(*snapshot_, last, guarded());
    warn();
  }
  const auto* space = followers_.find<SpaceKeeper>();
  const auto* surfaces = followers_.find<SurfaceKeeper>();
  if (!space || !surfaces) return;  // rooms are made of walls
  MapEdit edit;
  const bool found = guard_.run("rooms", [&] {
    const Span span(&scene_spans_, "find_structure");
    edit = structure_.propose(snapshot_, *space, *surfaces, newest_s_, &scene_spans_);
  });
  if (!found) return;
  const Snapshot before = snapshot_;
  apply(edit, {last ? EditEvent::Kind::rooms_last : EditEvent::Kind::rooms, newest_frame_, 0, 0});
  tell_of_rooms(*before);
}

// Numbers are never given again.
void MapOwner::tell_of_rooms(const Map& before) {
  for (const FoundRoom& room : snapshot_->structure().rooms) {
    if (room.number >= before.structure().next_number)
      tell([&](MapListener& listener) { listener.room_found(room.number, snapshot_); });
  }
}

void MapOwner::refine(const std::function<bool()>& stop) {
  SolveReport report;
  const MapEdit edit = mapper_.refine(newest_, snapshot_, stop, report, &spans_);
  apply(edit, {EditEvent::Kind::refine, newest_frame_, report.iterations, 0});
}

void MapOwner::apply(const MapEdit& edit, EditEvent event, const Followers* absorbed) {
  const Snapshot before = snapshot_;
  {
    const Span span(&spans_, "apply_edit");
    map_.apply(edit);
    snapshot_ = map_.snapshot();
  }
  {
    const Span span(&spans_, "follow_edit");
    followers_.follow(*before, edit, *snapshot_, absorbed, guarded());
  }
  if (options_.records_schedule()) {
    event.hash = edit.hash();
    edits_.push_back(event);
  }
  publish();
}

void MapOwner::warn() {
  for (const auto& follower : followers_.all())
    if (const std::string line = follower->warning(); !line.empty()) guard_.warn(line);
}

Followers::Guard MapOwner::guarded() {
  return [this](const char* part, const std::function<void()>& work) { return guard_.run(part, work); };
}

std::shared_ptr<const PlaceIndex> MapOwner::places() const {
  const auto* keeper = followers_.find<PlaceKeeper>();
  return keeper ? keeper->places() : std::make_shared<const PlaceIndex>();
}

void MapOwner::publish() {
  cell_.publish({snapshot_, inserted_, completed_before_adjustment_.value_or(completed_), places(),
                 published_dormant_, counts_, published_tallies_, guard_.warnings()});
}

}  // namespace vsgraphs
