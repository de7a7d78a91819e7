#include "core/vision/matching.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/vision/rotation_vote.h"

namespace vsgraphs {
namespace {

// A distance and an index in one number, so that the smaller is the better and ties go to the lower index.
using Key = std::uint32_t;
constexpr Key no_key = std::numeric_limits<Key>::max();
constexpr Key make_key(int distance, std::size_t index) {
  return static_cast<Key>(distance) << 16 | static_cast<Key>(index);
}
constexpr int distance_of(Key key) { return static_cast<int>(key >> 16); }
constexpr int index_of(Key key) { return static_cast<int>(key & 0xffffu); }

struct BestTwo {
  Key best = no_key, second = no_key;
  void add(Key key) {
    second = std::min(second, std::max(best, key));
    best = std::min(best, key);
  }
};

bool distinct(int best, int second, const MatchOptions& options) {
  return best <= options.max_distance && (options.ratio >= 1 || best < options.ratio * second);
}

std::vector<int> all_indices(const FeatureSet& set) {
  std::vector<int> indices(static_cast<std::size_t>(set.size()));
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<int>(i);
  return indices;
}

std::vector<Descriptor> gather(const FeatureSet& set, std::span<const int> subset) {
  std::vector<Descriptor> result;
  result.reserve(subset.size());
  for (int i : subset) result.push_back(set.descriptor(i));
  return result;
}

void require_indices(const FeatureSet& set, std::span<const int> subset) {
  for (int i : subset) VSG_INVARIANT(i >= 0 && i < set.size());
}

// Keeps what is mutual and distinct, then what turns alike; positions in the subsets become feature indices.
IndexPairs to_pairs(const FeatureSet& a, std::span<const int> subset_a, const FeatureSet& b,
                    std::span<const int> subset_b, std::span<const BestTwo> rows,
                    std::span<const Key> columns, const MatchOptions& options) {
  IndexPairs pairs;
  std::vector<float> turns;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const BestTwo& row = rows[i];
    if (row.best == no_key) continue;
    const auto j = static_cast<std::size_t>(index_of(row.best));
    const int second = row.second == no_key ? 257 : distance_of(row.second);
    if (!distinct(distance_of(row.best), second, options)) continue;
    if (index_of(columns[j]) != static_cast<int>(i)) continue;
    pairs.emplace_back(subset_a[i], subset_b[j]);
    turns.push_back(b[subset_b[j]].angle_rad - a[subset_a[i]].angle_rad);
  }
  if (!options.check_rotation) return pairs;
  const std::vector<bool> kept = consistent_rotation(turns);
  IndexPairs result;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (kept[k]) result.push_back(pairs[k]);
  return result;
}

// The closest candidate of one projected point that is distinct enough, as a key, or no_key.
Key best_candidate(const ProjectedPoint& point, const FeatureSet& features, std::span<const int> candidates,
                   const MatchOptions& options, std::span<const std::uint8_t> taken) {
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
  return distinct(distance_of(two.best), rival ? distance_of(two.second) : 257, options) ? two.best : no_key;
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
    int distance = 257;
    std::size_t point = 0;
  };
  std::vector<Claim> claims(static_cast<std::size_t>(features.size()));
  std::vector<int> candidates;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const ProjectedPoint& point = points[p];
    VSG_INVARIANT(point.descriptor != nullptr);
    candidates.clear();
    features.in_area(point.u, point.v, point.radius_px, point.min_level, point.max_level, candidates);
    const Key key = best_candidate(point, features, candidates, options, taken);
    if (key == no_key) continue;
    Claim& claim = claims[static_cast<std::size_t>(index_of(key))];
    if (distance_of(key) >= claim.distance) continue;
    if (claim.distance < 257) match[claim.point] = -1;
    claim = {distance_of(key), p};
    match[p] = index_of(key);
  }
  if (options.check_rotation) drop_odd_rotations(points, features, match);
  return match;
}

IndexPairs match_descriptors(const FeatureSet& a, const FeatureSet& b, const MatchOptions& options) {
  return match_descriptors(a, all_indices(a), b, all_indices(b), options);
}

IndexPairs match_descriptors(const FeatureSet& a, std::span<const int> subset_a, const FeatureSet& b,
                             std::span<const int> subset_b, const MatchOptions& options) {
  require_indices(a, subset_a);
  require_indices(b, subset_b);
  const std::vector<Descriptor> from = gather(a, subset_a), to = gather(b, subset_b);
  std::vector<BestTwo> rows(from.size());
  std::vector<Key> columns(to.size(), no_key), distances(to.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    // Two passes: counting bits keeps one unit of the processor busy, the minima another.
    for (std::size_t j = 0; j < to.size(); ++j)
      distances[j] = static_cast<Key>(hamming(from[i], to[j])) << 16;
    for (std::size_t j = 0; j < to.size(); ++j) {
      columns[j] = std::min(columns[j], distances[j] | static_cast<Key>(i));
      rows[i].add(distances[j] | static_cast<Key>(j));
    }
  }
  return to_pairs(a, subset_a, b, subset_b, rows, columns, options);
}

IndexPairs match_epipolar(const FeatureSet& a, std::span<const int> subset_a, const FeatureSet& b,
                          std::span<const int> subset_b, const Eigen::Matrix3d& fundamental,
                          const ScalePyramid& pyramid, double max_sigmas, const MatchOptions& options) {
  require_input(
      fundamental.allFinite() && fundamental.norm() > 0,
      "match_epipolar: the fundamental matrix is zero or not finite; the two views need a baseline");
  require_indices(a, subset_a);
  require_indices(b, subset_b);
  const Eigen::Matrix3f f = fundamental.cast<float>();
  std::vector<float> reach(subset_b.size());
  for (std::size_t j = 0; j < reach.size(); ++j)
    reach[j] = static_cast<float>(max_sigmas * pyramid.level_sigma_px(b[subset_b[j]].level));
  std::vector<BestTwo> rows(subset_a.size());
  std::vector<Key> columns(subset_b.size(), no_key);
  for (std::size_t i = 0; i < subset_a.size(); ++i) {
    const Feature& fa = a[subset_a[i]];
    Eigen::Vector3f line = f * Eigen::Vector3f(fa.u, fa.v, 1);
    const float norm = line.head<2>().norm();
    if (!(norm > 0)) continue;  // the epipole itself
    line /= norm;
    for (std::size_t j = 0; j < subset_b.size(); ++j) {
      const Feature& fb = b[subset_b[j]];
      if (std::abs(line.x() * fb.u + line.y() * fb.v + line.z()) > reach[j]) continue;
      const int distance = hamming(a.descriptor(subset_a[i]), b.descriptor(subset_b[j]));
      rows[i].add(make_key(distance, j));
      columns[j] = std::min(columns[j], make_key(distance, i));
    }
  }
  return to_pairs(a, subset_a, b, subset_b, rows, columns, options);
}

Descriptor representative(std::span<const Descriptor> descriptors) {
  require_input(!descriptors.empty(), "representative: no descriptor given");
  std::vector<int> distances(descriptors.size());
  std::size_t best = 0;
  int best_median = 257;
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
