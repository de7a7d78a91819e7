// The part of the map owner that deals with there being several maps.
#include <algorithm>

#include "core/base/check.h"
#include "core/system/maps/map_owner.h"

namespace vsgraphs {

void MapOwner::start_from(const AtlasState& known) {
  FirstIds unused;
  for (const MapState& state : known.maps) {
    unused = FirstIds::later(unused, state.map->unused_ids());
    if (state.map->keyframes().size() == 0) continue;
    const Followers followers = new_followers_.copy();
    followers.start(*state.map, state.followers);
    dormant_.push_back({{state.map, followers}, 0, true, false});
  }
  if (!dormant_.empty()) {
    const MapState last = dormant_.back().state;
    dormant_.pop_back();
    map_ = *last.map;
    map_.apply(OpenMap{unused, 0});
    snapshot_ = map_.snapshot();
    followers_ = last.followers;
    loaded_ = true;
  }
  publish_dormant();
}

std::vector<MapState> MapOwner::maps() const {
  std::vector<MapState> all = *published_dormant_;
  if (snapshot_->keyframes().size() > 0) all.push_back({snapshot_, followers_.copy()});
  return all;
}

void MapOwner::publish_dormant() {
  auto states = std::make_shared<std::vector<MapState>>();
  for (const DormantMap& dormant : dormant_) states->push_back(dormant.state);
  published_dormant_ = std::move(states);
}

// The map's followers go along with it.
void MapOwner::work_on_map(const Map& map, Followers followers) {
  map_ = map;
  snapshot_ = map_.snapshot();
  followers_ = std::move(followers);
  structure_.switch_map();
  looked_at_ = {};
}

bool MapOwner::choose_map(const KeyframeRequest& request) {
  if (request.first) {
    if (map_.keyframes().size() == 0) return false;
    open_new_map(request.frame_index);
    return true;
  }
  if (map_.reanchor(request.pose)) return false;
  for (std::size_t i = 0; i < dormant_.size(); ++i) {
    if (!dormant_[i].state.map->reanchor(request.pose)) continue;
    wake(i, EditEvent::Kind::resume, request.frame_index);
    return true;
  }
  return false;
}

bool MapOwner::settle() {
  const auto most =
      std::max_element(dormant_.begin(), dormant_.end(),
                       [](const DormantMap& a, const DormantMap& b) { return a.made < b.made; });
  if (most == dormant_.end() || most->made <= made_) return false;
  wake(static_cast<std::size_t>(most - dormant_.begin()), EditEvent::Kind::settle, newest_frame_);
  return true;
}

// Keeps the order of age: by the first keyframe ever made.
void MapOwner::put_to_sleep() {
  const KeyframeId first = snapshot_->keyframes().first();
  const auto behind = std::find_if(dormant_.begin(), dormant_.end(), [&](const DormantMap& d) {
    return first < d.state.map->keyframes().first();
  });
  dormant_.insert(behind,
                  {{snapshot_, followers_}, made_, loaded_, adjustment_ != nullptr, mapper_.put_away()});
  drop_adjustment();
}

void MapOwner::drop_small_maps() {
  const auto dropped = std::erase_if(dormant_, [this](const DormantMap& d) {
    return !d.loaded && static_cast<int>(d.state.map->keyframes().size()) < options_.min_map_keyframes;
  });
  counts_.dropped_maps += static_cast<int>(dropped);
}

void MapOwner::open_new_map(std::int64_t frame) {
  const OpenMap opening{map_.unused_ids(), map_.version()};
  put_to_sleep();
  drop_small_maps();
  work_on_map(Map{}, new_followers_.copy());
  made_ = 0;
  loaded_ = false;
  publish_dormant();
  apply({opening.version, {opening}}, {EditEvent::Kind::new_map, frame, 0, 0});
}

void MapOwner::wake(std::size_t index, EditEvent::Kind why, std::int64_t frame) {
  const DormantMap woken = dormant_[index];
  dormant_.erase(dormant_.begin() + static_cast<std::ptrdiff_t>(index));
  const OpenMap opening{map_.unused_ids(), map_.version()};
  put_to_sleep();
  work_on_map(*woken.state.map, woken.state.followers.copy());
  made_ = woken.made;
  loaded_ = woken.loaded;
  mapper_.take_up(woken.young);
  publish_dormant();
  apply({opening.version, {opening}}, {why, frame, 0, 0});
  if (woken.to_adjust) adjust_from_here();
}

void MapOwner::look_for_join() {
  join_.reset();
  if (!options_.loop_closing || !map_.keyframes().contains(newest_)) return;
  for (std::size_t i = 0; i < dormant_.size() && !join_; ++i) {
    guard_.run("loops", [&] {
      const MapState& other = dormant_[i].state;
      LoopReport report;
      auto join = loop_closer_.join(newest_, snapshot_, {other.map, other.places()}, report, &spans_);
      tally(tallies_.joins, report, *other.map);
      if (join) join_ = FoundJoin{i, std::move(*join)};
    });
  }
}

void MapOwner::join_maps() {
  VSG_INVARIANT(join_.has_value());
  const FoundJoin found = std::move(*join_);
  join_.reset();
  drop_adjustment();
  const DormantMap other = dormant_[found.dormant];
  dormant_.erase(dormant_.begin() + static_cast<std::ptrdiff_t>(found.dormant));
  Followers absorbed = other.state.followers;
  if (found.join.onto_other) {
    absorbed = followers_;
    work_on_map(*other.state.map, other.state.followers.copy());
  }
  mapper_.take_up(other.young);
  made_ += other.made;
  loaded_ |= other.loaded;
  ++counts_.merges;
  publish_dormant();
  apply(found.join.edit, {EditEvent::Kind::join, newest_frame_, 0, 0}, &absorbed);
  adjust_from_here();
}

}  // namespace vsgraphs
