#include "core/loops/loop_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/pose_covariance.h"

namespace vsgraphs {

namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;
// Two patches lie over each other where they come as close as this along the surface: their points are thinned out.
constexpr double touching_m = 0.2;
// Further apart across the surface they are different things; door leaves and cabinet fronts stand this far off a wall.
constexpr double beside_m = 0.4;
constexpr double min_overlap = 0.3;
constexpr double min_compared_m2 = 0.3;
constexpr int min_compared_samples = 100;

enum class Verdict { says_nothing, agrees, disagrees };

struct Overlap {
  double share = 0;     // of the first patch's points
  double offset_m = 0;  // mean signed distance of those from the second's plane
};

Overlap overlap_of(const SightedPatch& a, const SightedPatch& b) {
  Overlap overlap;
  for (const Eigen::Vector3d& p : a.points) {
    const double offset = b.plane.signed_distance(p);
    if (std::abs(offset) > beside_m) continue;
    const Eigen::Vector3d foot = p - offset * b.plane.normal;
    const bool over = std::any_of(b.points.begin(), b.points.end(), [&foot](const Eigen::Vector3d& q) {
      return (q - foot).squaredNorm() < touching_m * touching_m;
    });
    if (!over) continue;
    overlap.share += 1;
    overlap.offset_m += offset;
  }
  if (overlap.share > 0) overlap.offset_m /= overlap.share;
  overlap.share /= static_cast<double>(std::max<std::size_t>(1, a.points.size()));
  return overlap;
}

Verdict compare(const SightedPatch& a, const SightedPatch& b, const LoopCheckOptions& options) {
  const Overlap overlap = overlap_of(a, b);
  if (overlap.share < min_overlap) return Verdict::says_nothing;
  const double angle = std::acos(std::clamp(a.plane.normal.dot(b.plane.normal), -1.0, 1.0)) / rad_per_deg;
  const bool same_place = std::abs(overlap.offset_m) < options.same_offset_m;
  if (angle < options.same_angle_deg) return same_place ? Verdict::agrees : Verdict::disagrees;
  // One wall's two faces look away from each other, but not from one place.
  const double thinnest_wall_m = 0.4 * options.same_offset_m;
  if (angle > 180 - options.same_angle_deg)
    return std::abs(overlap.offset_m) < thinnest_wall_m ? Verdict::disagrees : Verdict::says_nothing;
  // Walls meet at corners, where patches touch; about square to each other they say nothing.
  return same_place && angle < 60 ? Verdict::disagrees : Verdict::says_nothing;
}

}  // namespace

std::vector<SightedPatch> placed_patches(const Map& map, const std::vector<KeyframeId>& keyframes,
                                         const Se3& correction) {
  std::vector<SightedPatch> placed;
  for (const KeyframeId id : keyframes) {
    const Keyframe* keyframe = map.keyframes().find(id);
    if (!keyframe || !keyframe->patches) continue;
    const Se3 world_from_camera = correction * keyframe->world_from_camera;
    for (const SurfacePatch& patch : keyframe->patches->patches) {
      SightedPatch& p = placed.emplace_back();
      p.plane = patch.plane.transformed(world_from_camera);
      p.area_m2 = static_cast<double>(patch.area_m2);
      for (const Eigen::Vector3f& point : patch.points)
        p.points.push_back(world_from_camera * point.cast<double>());
    }
  }
  return placed;
}

bool coincide(const SightedPatch& a, const SightedPatch& b, const LoopCheckOptions& options) {
  return compare(a, b, options) == Verdict::agrees;
}

SurfaceAgreement compare_surfaces(const std::vector<SightedPatch>& moved,
                                  const std::vector<SightedPatch>& standing,
                                  const LoopCheckOptions& options) {
  SurfaceAgreement agreement;
  for (const SightedPatch& a : moved) {
    bool agrees = false, disagrees = false;
    for (const SightedPatch& b : standing) {
      const Verdict verdict = compare(a, b, options);
      agrees |= verdict == Verdict::agrees;
      disagrees |= verdict == Verdict::disagrees;
    }
    // A poster's board hangs in front of a wall: to coincide with one of the two is enough.
    if (agrees) {
      agreement.agreeing_m2 += a.area_m2;
    } else if (disagrees) {
      agreement.disagreeing_m2 += a.area_m2;
    }
  }
  return agreement;
}

bool surfaces_agree(const SurfaceAgreement& agreement, const LoopCheckOptions& options) {
  const double compared = agreement.agreeing_m2 + agreement.disagreeing_m2;
  return compared < min_compared_m2 || agreement.disagreeing_m2 <= options.max_disagreeing_share * compared;
}

bool stays_upright(const Se3& correction, const std::optional<Eigen::Vector3d>& up_moved,
                   const std::optional<Eigen::Vector3d>& up_standing, const LoopCheckOptions& options) {
  if (!up_moved || !up_standing) return true;
  const double cosine = up_standing->dot(correction.rotation() * *up_moved);
  return cosine >= std::cos(options.max_tilt_deg * rad_per_deg);
}

bool leaves_free_space_free(const FreeSpaceCount& count, const LoopCheckOptions& options) {
  return count.seen < min_compared_samples || count.through <= options.max_seen_through_share * count.seen;
}

bool neighbours_agree(const FreeSpaceCount& count, const LoopCheckOptions& options) {
  return count.through <= options.max_contradicted_share * count.seen;
}

double drift_sigmas(const Se3& place_from_keyframe, const Se3& place_from_keyframe_aligned,
                    const Drift& drift, const Matrix6d& alignment_information) {
  const Vector6d error = (place_from_keyframe.inverse() * place_from_keyframe_aligned).log();
  return sigmas_of(error, drift.covariance + covariance_of(alignment_information));
}

}  // namespace vsgraphs
