#include "core/tracking/landmark_sightings.h"

#include <algorithm>

namespace vsgraphs {

void LandmarkSightings::count(const FrameMatches& matches, const std::vector<LandmarkId>& expected,
                              int min_matches) {
  for (const Correspondence& c : matches.all()) {
    if (c.landmark.valid()) ++counts_[c.landmark].found;
  }
  if (matches.size() < min_matches) return;
  for (const LandmarkId id : expected) ++counts_[id].visible;
}

std::vector<Sighting> LandmarkSightings::take() {
  std::vector<Sighting> sightings;
  sightings.reserve(counts_.size());
  for (const auto& [id, count] : counts_) sightings.push_back({id, count.visible, count.found});
  std::sort(sightings.begin(), sightings.end(),
            [](const Sighting& a, const Sighting& b) { return a.landmark < b.landmark; });
  counts_.clear();
  return sightings;
}

}  // namespace vsgraphs
