#include "core/tracking/relocaliser.h"

#include <cmath>
#include <utility>
#include <vector>

namespace vsgraphs {

namespace {

// The map the camera was lost in, the active one, the others.
std::vector<const KnownMap*> in_order(const KnownMaps& known, const KnownMap* last_in) {
  std::vector<const KnownMap*> order;
  if (last_in) order.push_back(last_in);
  if (last_in != &known.active) order.push_back(&known.active);
  for (const KnownMap& dormant : known.dormant) {
    if (last_in != &dormant) order.push_back(&dormant);
  }
  return order;
}

}  // namespace

std::optional<Relocalisation> Relocaliser::search(const KnownMaps& known, const KnownMap* last_in,
                                                  const LastFrame& last, const FrameState& now) {
  if (last_in) {
    if (auto found = near_last_frame(*last_in->map, last, now))
      return Relocalisation{last_in, std::move(*found)};
  }
  for (const KnownMap* candidate : in_order(known, last_in)) {
    if (auto found = by_look(*candidate, candidate == last_in ? &last : nullptr, now))
      return Relocalisation{candidate, std::move(*found)};
  }
  return std::nullopt;
}

std::optional<MatchedPose> Relocaliser::near_last_frame(const Map& map, const LastFrame& last,
                                                        const FrameState& now) {
  const FrameState& then = last.state();
  const PosedView view{*then.features, then.landmarks, last.world_from_camera()};
  auto found =
      search_around(map, recovery_.from_recent(map, *now.features, now.index, view, then.pose.keyframe),
                    then.pose.keyframe, options_.recovery.min_relocalisation_inliers, now);
  if (found && !in_reach(last, now, *found)) found.reset();
  return found;
}

// `last_here`: the last frame, where this map holds it.
std::optional<MatchedPose> Relocaliser::by_look(const KnownMap& known, const LastFrame* last_here,
                                                const FrameState& now) {
  const Map& map = *known.map;
  // Nothing says that the camera is in this map at all. Where it may start one of its own there is time: what the two have in
  // common will show, from more than one view.
  const bool may_wait = !last_here && std::isfinite(options_.new_map_after_s);
  const int enough = (may_wait ? 2 : 1) * options_.recovery.min_place_inliers;
  const RoomNumber last_room =
      last_here ? map.room_at(last_here->world_from_camera().translation()) : no_room;
  for (const KeyframeId place : recovery_.likely_places(known, *now.features, last_room)) {
    auto found =
        search_around(map, recovery_.from_keyframe(map, place, *now.features, now.index), place, enough, now);
    if (found && (!last_here || in_reach(*last_here, now, *found))) return found;
  }
  return std::nullopt;
}

// A pose by look from one keyframe may rest on few matches: what lies around is looked for, first widely, then narrowly,
// and must be there.
std::optional<MatchedPose> Relocaliser::search_around(const Map& map, std::optional<MatchedPose> guess,
                                                      KeyframeId near, int min_inliers,
                                                      const FrameState& now) {
  for (const double radius_px : {options_.search_radius_px, options_.local_search_radius_px}) {
    if (!guess) return std::nullopt;
    guess = local_map_.refine(map, now, std::move(*guess), near, radius_px);
  }
  const bool good = guess && guess->pose.inliers >= min_inliers &&
                    verifier_.fits(map, local_map_.local_map(), *now.surface, guess->pose);
  return good ? guess : std::nullopt;
}

// Nothing is known of the motion after a loss: speed and turn alone decide.
bool Relocaliser::in_reach(const LastFrame& last, const FrameState& now, const MatchedPose& found) const {
  const MotionGate gate(options_, last.world_from_camera(), now.timestamp_s - last.state().timestamp_s, {});
  return gate.passes(found.pose.world_from_camera);
}

}  // namespace vsgraphs
