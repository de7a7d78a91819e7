// Which feature is which: by where a point should appear, by descriptor alone, or along an epipolar line.
// All functions are deterministic: equal distances go to the lower index. Pixels are undistorted, level 0.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/map/features.h"
#include "core/vision/scale_pyramid.h"

namespace vsgraphs {

// Where a landmark is expected in the image, and what it looks like.
struct ProjectedPoint {
  float u = 0, v = 0;                      // expected pixel
  float radius_px = 0;                     // half side of the square to search
  int min_level = 0, max_level = 0;        // pyramid levels to search, inclusive
  const Descriptor* descriptor = nullptr;  // not owned; must outlive the call
  float angle_rad = 0;                     // orientation it had where it was seen, for check_rotation
  bool has_angle = false;
  float inverse_depth = 0;  // predicted, 1/m; 0: not known
  float inverse_depth_gate =
      0;  // features with depth further off than this (1/m) are not candidates; 0: no gate
};

struct MatchOptions {
  int max_distance = 100;       // bits of 256
  double ratio = 0.9;           // best distance must be below ratio * second best; 1: off
  bool check_rotation = false;  // keep only pairs turned like most others (3 highest of 30 histogram bins)
};

using IndexPairs = std::vector<std::pair<int, int>>;

// Per point the index of its feature, or -1. A feature goes to the point closest to it in descriptor, others
// go without. The second best counts for the ratio only at the best one's level, as neighbouring levels often
// hold the same corner. `taken`: one flag per feature, nonzero ones are skipped; empty: none. Throws
// InputError if `taken` has another size. 1000 points with windows of 30 px: about 0.2 ms.
std::vector<int> match_projected(std::span<const ProjectedPoint> points, const FeatureSet& features,
                                 const MatchOptions& options, std::span<const std::uint8_t> taken = {});

// Brute force: pairs (index in a, index in b) that are each other's nearest, ascending in a. The ratio is
// tested from a's side; the same corner found at another level (within 6 px) is no rival. 1000 x 1000 takes
// about 1.9 ms. The second form sees only the given indices (ascending).
IndexPairs match_descriptors(const FeatureSet& a, const FeatureSet& b, const MatchOptions& options);
IndexPairs match_descriptors(const FeatureSet& a, std::span<const int> subset_a, const FeatureSet& b,
                             std::span<const int> subset_b, const MatchOptions& options);

// Mutual nearest pairs among those where b's feature lies within `max_sigmas` of its level's sigma from the
// epipolar line of a's. `fundamental` maps pixels of a to lines in b: pb^T F pa = 0, undistorted pixels.
// The ratio is tested among the candidates on the line.
IndexPairs match_epipolar(const FeatureSet& a, std::span<const int> subset_a, const FeatureSet& b,
                          std::span<const int> subset_b, const Eigen::Matrix3d& fundamental,
                          const ScalePyramid& pyramid, double max_sigmas, const MatchOptions& options);

// The descriptor with the least median distance to the others (ties: the first). Throws InputError when
// empty.
Descriptor representative(std::span<const Descriptor> descriptors);

}  // namespace vsgraphs
