#include <cmath>
#include <numeric>

#include "core/base/check.h"
#include "core/vision/match_key.h"
#include "core/vision/matching.h"
#include "core/vision/rotation_vote.h"

namespace vsgraphs {
namespace {

std::vector<int> all_indices(const FeatureSet& set) {
  std::vector<int> indices(static_cast<std::size_t>(set.size()));
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

std::vector<Descriptor> gather(const FeatureSet& set, std::span<const int> subset) {
  std::vector<Descriptor> result;
  result.reserve(subset.size());
  for (int i : subset) {
    VSG_INVARIANT(i >= 0 && i < set.size());
    result.push_back(set.descriptor(i));
  }
  return result;
}

// One corner is often found at two neighbouring levels, a few pixels apart. To take the one for the other
// does no harm, so they are no rivals of each other.
bool same_corner(const Feature& a, const Feature& b) {
  constexpr float reach_px = 6;
  return a.level != b.level && std::abs(a.u - b.u) < reach_px && std::abs(a.v - b.v) < reach_px;
}

void keep_common_turn(const FeatureSet& a, const FeatureSet& b, IndexPairs& pairs) {
  std::vector<float> turns;
  turns.reserve(pairs.size());
  for (const auto& [i, j] : pairs) turns.push_back(b[j].angle_rad - a[i].angle_rad);
  const std::vector<bool> kept = consistent_rotation(turns);
  std::size_t count = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (kept[k]) pairs[count++] = pairs[k];
  pairs.resize(count);
}

// `for_candidates(i, f)` calls f(j, distance) for every candidate of the i-th feature, by positions in the
// subsets.
template <typename ForCandidates>
IndexPairs mutual_pairs(const FeatureSet& a, std::span<const int> subset_a, const FeatureSet& b,
                        std::span<const int> subset_b, const MatchOptions& options,
                        const ForCandidates& for_candidates) {
  std::vector<BestTwo> rows(subset_a.size());
  std::vector<MatchKey> columns(subset_b.size(), no_key);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    BestTwo row;
    for_candidates(i, [&](std::size_t j, int distance) {
      row.add(make_key(distance, j));
      columns[j] = std::min(columns[j], make_key(distance, i));
    });
    rows[i] = row;
  }
  IndexPairs pairs;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int distance = distance_of(rows[i].best);
    if (distance > options.max_distance) continue;
    const auto j = static_cast<std::size_t>(index_of(rows[i].best));
    if (index_of(columns[j]) != static_cast<int>(i)) continue;
    const Feature& best = b[subset_b[j]];
    int rival = distance_of(rows[i].second);
    if (rival < no_distance &&
        same_corner(best, b[subset_b[static_cast<std::size_t>(index_of(rows[i].second))]])) {
      rival = no_distance;
      for_candidates(i, [&](std::size_t k, int other) {
        if (other < rival && k != j && !same_corner(best, b[subset_b[k]])) rival = other;
      });
    }
    if (distinct(distance, rival, options)) pairs.emplace_back(subset_a[i], subset_b[j]);
  }
  if (options.check_rotation) keep_common_turn(a, b, pairs);
  return pairs;
}

}  // namespace

IndexPairs match_descriptors(const FeatureSet& a, const FeatureSet& b, const MatchOptions& options) {
  return match_descriptors(a, all_indices(a), b, all_indices(b), options);
}

IndexPairs match_descriptors(const FeatureSet& a, std::span<const int> subset_a, const FeatureSet& b,
                             std::span<const int> subset_b, const MatchOptions& options) {
  const std::vector<Descriptor> from = gather(a, subset_a), to = gather(b, subset_b);
  return mutual_pairs(a, subset_a, b, subset_b, options, [&](std::size_t i, const auto& add) {
    const Descriptor mine = from[i];
    for (std::size_t j = 0; j < to.size(); ++j) add(j, hamming(mine, to[j]));
  });
}

IndexPairs match_epipolar(const FeatureSet& a, std::span<const int> subset_a, const FeatureSet& b,
                          std::span<const int> subset_b, const Eigen::Matrix3d& fundamental,
                          const ScalePyramid& pyramid, double max_sigmas, const MatchOptions& options) {
  require_input(
      fundamental.allFinite() && fundamental.norm() > 0,
      "match_epipolar: the fundamental matrix is zero or not finite; the two views need a baseline");
  struct Target {
    float u, v, reach;
  };
  std::vector<Target> targets;
  targets.reserve(subset_b.size());
  for (int j : subset_b) {
    const Feature& f = b[j];
    targets.push_back({f.u, f.v, static_cast<float>(max_sigmas * pyramid.level_sigma_px(f.level))});
  }
  const std::vector<Descriptor> from = gather(a, subset_a), to = gather(b, subset_b);
  const Eigen::Matrix3f line_from_a = fundamental.cast<float>();
  return mutual_pairs(a, subset_a, b, subset_b, options, [&](std::size_t i, const auto& add) {
    const Feature& f = a[subset_a[i]];
    const Eigen::Vector3f line = line_from_a * Eigen::Vector3f(f.u, f.v, 1);
    const float norm = line.head<2>().norm();
    if (!(norm > 0)) return;  // the epipole itself
    const float x = line.x() / norm, y = line.y() / norm, z = line.z() / norm;
    for (std::size_t j = 0; j < targets.size(); ++j) {
      const Target& t = targets[j];
      if (std::abs(x * t.u + y * t.v + z) <= t.reach) add(j, hamming(from[i], to[j]));
    }
  });
}

}  // namespace vsgraphs
