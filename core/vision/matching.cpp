#include "core/vision/matching.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/vision/match_key.h"
#include "core/vision/rotation_vote.h"

namespace vsgraphs {
namespace {

// The closest candidate of one projected point that is distinct enough, as a key, or no_key.
MatchKey best_candidate(const ProjectedPoint& point, const FeatureSet& features,
                        std::span<const int> candidates, const MatchOptions& options,
                        std::span<const std::uint8_t> taken) {
  BestTwo two;
  for (int i : candidates) {
    if (!taken.empty() && taken[static_cast<std::size_t>(i)]) continue;
    const Feature& f = features[i];
    if (point.inverse_depth_gate > 0 && point.inverse_depth > 0 && f.has_depth() &&
        std::abs(1 / f.depth_m - point.inverse_depth) > point.inverse_depth_gate) {
      continue;
    }
    two.add(make_key(hamming(*point.descriptor, features.descriptor(i)), static_cast<std::size_t>(i)));
  }
  if (two.best == no_key) return no_key;
  const bool rival =
      two.second != no_key && features[index_of(two.best)].level == features[index_of(two.second)].level;
  return distinct(distance_of(two.best), rival ? distance_of(two.second) : no_distance, options) ? two.best
                                                                                                 : no_key;
}

void drop_odd_rotations(std::span<const ProjectedPoint> points, const FeatureSet& features,
                        std::vector<int>& match) {
  std::vector<float> turns;
  std::vector<std::size_t> who;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (match[p] < 0 || !points[p].has_angle) continue;
    turns.push_back(features[match[p]].angle_rad - points[p].angle_rad);
    who.push_back(p);
  }
  const std::vector<bool> kept = consistent_rotation(turns);
  for (std::size_t k = 0; k < who.size(); ++k)
    if (!kept[k]) match[who[k]] = -1;
}

}  // namespace

std::vector<int> match_projected(std::span<const ProjectedPoint> points, const FeatureSet& features,
                                 const MatchOptions& options, std::span<const std::uint8_t> taken) {
  require_input(taken.empty() || taken.size() == static_cast<std::size_t>(features.size()),
                "match_projected: `taken` needs one flag per feature");
  std::vector<int> match(points.size(), -1);
  // Per feature the best claim on it: distance, then point.
  struct Claim {
    int distance = no_distance;
    std::size_t point = 0;
  };
  std::vector<Claim> claims(static_cast<std::size_t>(features.size()));
  std::vector<int> candidates;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const ProjectedPoint& point = points[p];
    VSG_INVARIANT(point.descriptor != nullptr);
    candidates.clear();
    features.in_area(point.u, point.v, point.radius_px, point.min_level, point.max_level, candidates);
    const MatchKey key = best_candidate(point, features, candidates, options, taken);
    if (key == no_key) continue;
    Claim& claim = claims[static_cast<std::size_t>(index_of(key))];
    if (distance_of(key) >= claim.distance) continue;
    if (claim.distance < no_distance) match[claim.point] = -1;
    claim = {distance_of(key), p};
    match[p] = index_of(key);
  }
  if (options.check_rotation) drop_odd_rotations(points, features, match);
  return match;
}

Descriptor representative(std::span<const Descriptor> descriptors) {
  require_input(!descriptors.empty(), "representative: no descriptor given");
  std::vector<int> distances(descriptors.size());
  std::size_t best = 0;
  int best_median = no_distance;
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    for (std::size_t j = 0; j < descriptors.size(); ++j)
      distances[j] = hamming(descriptors[i], descriptors[j]);
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    if (*middle >= best_median) continue;
    best_median = *middle;
    best = i;
  }
  return descriptors[best];
}

}  // namespace vsgraphs
