// Which keyframes show the place an image shows, judged by how many strong features find their like.
#pragma once

#include <span>
#include <vector>

#include "core/map/features.h"

namespace vsgraphs {

struct KnownPlace {
  int id = 0;                            // the caller's name for it
  const FeatureSet* features = nullptr;  // not owned
};

struct PlaceCandidate {
  int id = 0;
  double score = 0;  // share of the query's strong features with a mutual, distinct match, 0..1
};

struct PlaceSearchOptions {
  int strongest = 150;  // features compared per image: the first ones, as the extractor orders by strength
  int max_candidates = 5;
  int max_distance = 64;    // bits of 256
  double min_score = 0.03;  // below this nothing was recognised
};

// The most similar places, best first (ties: as given). About 40 us per place.
std::vector<PlaceCandidate> find_place_candidates(const FeatureSet& query, std::span<const KnownPlace> places,
                                                  const PlaceSearchOptions& options);

}  // namespace vsgraphs
