#include "core/vision/place_candidates.h"

#include <algorithm>
#include <numeric>

#include "core/base/check.h"
#include "core/vision/matching.h"

namespace vsgraphs {
namespace {

std::vector<int> strongest(const FeatureSet& set, int count) {
  std::vector<int> indices(static_cast<std::size_t>(std::min(count, set.size())));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

}  // namespace

std::vector<PlaceCandidate> find_place_candidates(const FeatureSet& query, std::span<const KnownPlace> places,
                                                  const PlaceSearchOptions& options) {
  require_input(options.strongest > 0 && options.max_candidates >= 0,
                "place candidates: strongest must be positive and max_candidates not negative");
  std::vector<PlaceCandidate> candidates;
  const std::vector<int> of_query = strongest(query, options.strongest);
  if (of_query.empty()) return candidates;
  const MatchOptions matching{.max_distance = options.max_distance, .ratio = 0.9, .check_rotation = true};
  for (const KnownPlace& place : places) {
    VSG_INVARIANT(place.features != nullptr);
    const std::vector<int> of_place = strongest(*place.features, options.strongest);
    const std::size_t found = match_descriptors(query, of_query, *place.features, of_place, matching).size();
    const double score = static_cast<double>(found) / static_cast<double>(of_query.size());
    if (score >= options.min_score) candidates.push_back({place.id, score});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.score > b.score; });
  if (candidates.size() > static_cast<std::size_t>(options.max_candidates))
    candidates.resize(static_cast<std::size_t>(options.max_candidates));
  return candidates;
}

}  // namespace vsgraphs
