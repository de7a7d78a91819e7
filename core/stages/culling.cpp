#include "core/stages/culling.h"

#include <algorithm>

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

namespace {

// Others that see the landmark at the same or a finer scale.
bool well_witnessed(const CullingOptions& options, const Map& map, const Landmark& landmark,
                    KeyframeId keyframe, int level) {
  int witnesses = 0;
  for (const Observation& o : landmark.observations) {
    if (o.keyframe == keyframe) continue;
    const Keyframe* other = map.keyframes().find(o.keyframe);
    if (other && (*other->features)[o.feature].level <= level + 1 &&
        ++witnesses >= options.redundant_witnesses) {
      return true;
    }
  }
  return false;
}

bool redundant(const CullingOptions& options, const Map& map, KeyframeId id) {
  const Keyframe& keyframe = *map.keyframes().find(id);
  int seen = 0, shared = 0;
  for (std::size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    const Landmark* landmark = map.landmarks().find(keyframe.landmarks[i]);
    const Feature& feature = (*keyframe.features)[static_cast<int>(i)];
    if (!landmark || !feature.has_depth()) continue;
    ++seen;
    shared += well_witnessed(options, map, *landmark, id, feature.level);
  }
  return seen > 0 && shared > options.redundant_share * seen;
}

}  // namespace

void cull_keyframes(const CullingOptions& options, const std::vector<KeyframeId>& candidates, Draft& draft) {
  KeyframeId first;
  for (std::uint32_t index = 0; !first.valid() && index < draft.map().keyframes().index_bound(); ++index)
    first = draft.map().keyframes().at_index(index);
  for (const KeyframeId id : candidates) {
    const Map& map = draft.map();
    const Keyframe* keyframe = map.keyframes().find(id);
    if (!keyframe || id == first || keyframe->tracked_link || !redundant(options, map, id)) continue;
    const auto neighbours = map.covisible(id, 1);
    if (!neighbours.empty()) draft.record(RemoveKeyframe{id, neighbours.front().first});
  }
}

}  // namespace vsgraphs
