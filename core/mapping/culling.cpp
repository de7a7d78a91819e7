#include "core/mapping/culling.h"

#include <algorithm>
#include <set>

namespace vsgraphs {

void Probation::admit(const std::vector<LandmarkId>& landmarks, std::int64_t keyframe_count) {
  for (const LandmarkId id : landmarks) entries_.push_back({id, keyframe_count});
}

void Probation::judge(const CullingOptions& options, std::int64_t keyframe_count, Draft& draft) {
  std::deque<Entry> remaining;
  for (const Entry& entry : entries_) {
    const Landmark* landmark = draft.map().landmarks().find(entry.landmark);
    if (!landmark) continue;
    const auto age = keyframe_count - entry.born;
    const auto observations = static_cast<int>(landmark->observations.size());
    const bool seldom_found = landmark->found_count < options.min_found_share * landmark->visible_count;
    const bool thinly_observed =
        age >= options.probation_keyframes - 1 && observations < options.min_observations;
    if (seldom_found || thinly_observed || observations == 0) {
      draft.record(RemoveLandmark{entry.landmark});
    } else if (age < options.probation_keyframes) {
      remaining.push_back(entry);
    }
  }
  entries_ = std::move(remaining);
}

void Probation::take_up(const Probation& others, std::int64_t their_count, std::int64_t keyframe_count) {
  for (const Entry& entry : others.entries_)
    entries_.push_back({entry.landmark, entry.born + keyframe_count - their_count});
}

namespace {

// Who sees a landmark at the same or a finer scale.
struct Witnesses {
  bool enough = false;
  bool made_before = false;  // one of them long before the keyframe asked about
};

Witnesses witnesses_of(const CullingOptions& options, const Map& map, const Landmark& landmark,
                       KeyframeId keyframe, int level) {
  const auto gap = static_cast<std::uint32_t>(options.revisit_gap_keyframes);
  Witnesses result;
  int count = 0;
  for (const Observation& o : landmark.observations) {
    if (o.keyframe == keyframe) continue;
    const Keyframe* other = map.keyframes().find(o.keyframe);
    if (!other || (*other->features)[o.feature].level > level + 1) continue;
    result.enough |= ++count >= options.redundant_witnesses;
    result.made_before |= o.keyframe.index + gap <= keyframe.index;
    if (result.enough && result.made_before) break;
  }
  return result;
}

// Shares of a keyframe's landmarks with depth: those that enough others see, and of these those that were seen long before.
struct WitnessedShares {
  int landmarks = 0;
  double witnessed = 0;
  double known_before = 0;
};

WitnessedShares witnessed_shares(const CullingOptions& options, const Map& map, KeyframeId id) {
  const Keyframe& keyframe = *map.keyframes().find(id);
  WitnessedShares shares;
  int witnessed = 0, known_before = 0;
  for (std::size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    const Landmark* landmark = map.landmarks().find(keyframe.landmarks[i]);
    const Feature& feature = (*keyframe.features)[static_cast<int>(i)];
    if (!landmark || !feature.has_depth()) continue;
    ++shares.landmarks;
    const Witnesses witnesses = witnesses_of(options, map, *landmark, id, feature.level);
    witnessed += witnesses.enough;
    known_before += witnesses.enough && witnesses.made_before;
  }
  if (shares.landmarks > 0) {
    shares.witnessed = static_cast<double>(witnessed) / shares.landmarks;
    shares.known_before = static_cast<double>(known_before) / shares.landmarks;
  }
  return shares;
}

// The oldest keyframe that stands where this one does, made long before it.
KeyframeId made_here_before(const CullingOptions& options, const Map& map, KeyframeId id) {
  const Se3 camera_from_world = map.keyframes().find(id)->world_from_camera.inverse();
  const auto gap = static_cast<std::uint32_t>(options.revisit_gap_keyframes);
  for (std::uint32_t index = 0; index + gap <= id.index; ++index) {
    const KeyframeId other = map.keyframes().at_index(index);
    if (!other.valid()) continue;
    const Se3 step = camera_from_world * map.keyframes().find(other)->world_from_camera;
    if (step.translation().norm() < options.revisit_m &&
        rotation_angle(step.rotation()) < options.revisit_rad)
      return other;
  }
  return {};
}

// Whether at least so many other keyframes see the plane; one may have several patches on it.
bool seen_by_others(const MappedPlane& plane, KeyframeId id, int enough) {
  std::set<KeyframeId> others;
  for (const PlaneObservation& o : plane.observations) {
    if (o.keyframe != id) others.insert(o.keyframe);
    if (static_cast<int>(others.size()) >= enough) return true;
  }
  return enough <= 0;
}

// What a keyframe that is about to go saw of planes that enough others saw; its patches, if that was all. Retired ones that
// kept theirs count: a plane that few living ones see would otherwise gather another sight at every return.
void forget_surfaces(const CullingOptions& options, KeyframeId id, Draft& draft) {
  std::vector<std::pair<PlaneId, PlaneObservation>> forgotten;
  bool all = true;
  draft.map().planes().for_each([&](PlaneId plane_id, const MappedPlane& plane) {
    std::vector<PlaneObservation> own;
    for (const PlaneObservation& o : plane.observations)
      if (o.keyframe == id) own.push_back(o);
    if (own.empty()) return;
    if (!seen_by_others(plane, id, options.redundant_witnesses)) {
      all = false;
      return;
    }
    for (const PlaneObservation& o : own) forgotten.emplace_back(plane_id, o);
  });
  if (all && draft.map().keyframes().find(id)->patches) {
    draft.record(SetPatches{id, nullptr});
    return;
  }
  for (const auto& [plane, observation] : forgotten) draft.record(RemovePlaneObservation{plane, observation});
}

// Where frames and links that hang on a keyframe go when it does; invalid if there is nowhere. Never one that is linked to it, which
// would hang on itself then.
KeyframeId successor(const Map& map, KeyframeId id, KeyframeId made_before) {
  constexpr int firmly_shared = 15;  // landmarks
  const auto may = [&](KeyframeId other) {
    const auto link = map.living_link(other);
    return !link || link->to != id;
  };
  const auto link = map.living_link(id);
  // One of its own stretch, if there is any: what hangs on it stays with the stretch.
  KeyframeId nearest;
  for (const auto& [neighbour, shared] : map.covisible(id, link ? firmly_shared : 1)) {
    if (!may(neighbour)) continue;
    if (map.stretch_of(neighbour) == map.stretch_of(id)) return neighbour;
    if (!nearest.valid()) nearest = neighbour;
  }
  if (nearest.valid()) return nearest;
  // Tracking measured this step; that the camera came back is only what the map makes of all steps since.
  if (link && may(link->to)) return link->to;
  return made_before.valid() && may(made_before) ? made_before : KeyframeId{};
}

// A stretch hangs on its first keyframe: that does not go to another stretch while others of its own live.
bool carries_others(const Map& map, KeyframeId id, KeyframeId anchor) {
  if (map.stretch_of(id) != id || map.stretch_of(anchor) == id) return false;
  for (std::uint32_t index = id.index + 1; index < map.keyframes().index_bound(); ++index) {
    const Keyframe* other = map.keyframes().find(map.keyframes().at_index(index));
    if (other && other->stretch == id) return true;
  }
  return false;
}

bool may_be_revisit(const CullingOptions& options, const Keyframe& keyframe, const WitnessedShares& shares) {
  // Held by surfaces alone: they were seen before wherever the camera stood before.
  if (shares.landmarks == 0) return keyframe.tracked_link.has_value();
  return shares.known_before >= options.revisit_share;
}

}  // namespace

void cull_keyframes(const CullingOptions& options, const std::vector<KeyframeId>& candidates, Draft& draft) {
  const KeyframeId first = draft.map().keyframes().first();
  for (const KeyframeId id : candidates) {
    const Map& map = draft.map();
    const Keyframe* keyframe = map.keyframes().find(id);
    if (!keyframe || id == first) continue;
    const WitnessedShares shares = witnessed_shares(options, map, id);
    const bool redundant = shares.witnessed > options.redundant_share && !keyframe->tracked_link;
    const KeyframeId before =
        may_be_revisit(options, *keyframe, shares) ? made_here_before(options, map, id) : KeyframeId{};
    if (!redundant && !before.valid()) continue;
    const KeyframeId anchor = successor(map, id, before);
    if (!anchor.valid() || carries_others(map, id, anchor)) continue;
    if (before.valid()) forget_surfaces(options, id, draft);
    draft.record(RemoveKeyframe{id, anchor, before.valid()});
  }
}

}  // namespace vsgraphs
