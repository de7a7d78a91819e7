// The semantic half of a loop's verification: whether the surfaces seen from both sides, moved together, can be the same
// rooms. Each check is a pure function; none trusts a look.
#pragma once

#include <optional>
#include <vector>

#include "core/base/options.h"
#include "core/geometry/camera.h"
#include "core/loops/loop_graph.h"
#include "core/map/map.h"
#include "core/matching/free_space_check.h"

namespace vsgraphs {

struct LoopCheckOptions {
  double max_tilt_deg = 5.0;
  double same_angle_deg = 10.0;
  double same_offset_m = 0.12;
  double max_disagreeing_share = 0.35;
  double max_seen_through_share = 0.35;
  double max_contradicted_share = 0.01;
  double max_drift_sigmas = 4.0;
};

template <typename Visitor>
void describe(LoopCheckOptions& o, Visitor& field) {
  field("max_tilt_deg", o.max_tilt_deg, 0.1, 45.0,
        "largest change of the up direction that a loop may bring, in degrees");
  field("same_angle_deg", o.same_angle_deg, 1.0, 45.0,
        "largest angle between two observations of one surface, in degrees, when a loop is checked");
  field("same_offset_m", o.same_offset_m, 0.01, 1.0,
        "largest distance between two observations of one surface, in metres, when a loop is checked");
  field("max_disagreeing_share", o.max_disagreeing_share, 0.0, 1.0,
        "largest share of the surface seen from both ends of a loop that may disagree");
  field("max_seen_through_share", o.max_seen_through_share, 0.0, 1.0,
        "largest share of the surfaces at one end of a loop that the other end may have looked through");
  field("max_contradicted_share", o.max_contradicted_share, 0.0, 1.0,
        "largest share of all surfaces of two maps that the other map may have looked through when they are "
        "joined");
  field("max_drift_sigmas", o.max_drift_sigmas, 1.0, 100.0,
        "largest correction by a loop, in standard deviations of the expected drift");
}

// A planar piece where it stands in the world.
struct SightedPatch {
  AnchoredPlane plane;
  std::vector<Eigen::Vector3d> points;
  double area_m2 = 0;
};
// The patches of `keyframes`, moved by `correction` (world from world). Keyframes without patches add nothing.
std::vector<SightedPatch> placed_patches(const Map& map, const std::vector<KeyframeId>& keyframes,
                                         const Se3& correction);

// Over each other, at one angle and offset, facing one way: two sights of one surface.
bool coincide(const SightedPatch& a, const SightedPatch& b, const LoopCheckOptions& options);

// Surface of `moved` that coincides with a patch of `standing`, and surface that contradicts one: side by side with it at
// another angle, parallel at a distance no second surface explains, or facing the other way in the same place. What
// only one side saw counts for neither.
struct SurfaceAgreement {
  double agreeing_m2 = 0;
  double disagreeing_m2 = 0;
};
SurfaceAgreement compare_surfaces(const std::vector<SightedPatch>& moved,
                                  const std::vector<SightedPatch>& standing, const LoopCheckOptions& options);
bool surfaces_agree(const SurfaceAgreement& agreement, const LoopCheckOptions& options);

// Whether what is moved has up where it was: `up` on the side that moves and on the side that stands. True while one of them
// is not known.
bool stays_upright(const Se3& correction, const std::optional<Eigen::Vector3d>& up_moved,
                   const std::optional<Eigen::Vector3d>& up_standing, const LoopCheckOptions& options);

bool leaves_free_space_free(const FreeSpaceCount& count, const LoopCheckOptions& options);
// Of two maps side by side, keyframes from all over the one against such of the other: two rooms may look alike, and stand alike
// where the camera stands, but what surrounds them differs.
bool neighbours_agree(const FreeSpaceCount& count, const LoopCheckOptions& options);

// How many standard deviations of `drift` (and of the alignment itself) lie between where the map has the keyframe, seen from
// the place, and where the alignment has it: the square root of a chi-square with six degrees of freedom.
double drift_sigmas(const Se3& place_from_keyframe, const Se3& place_from_keyframe_aligned,
                    const Drift& drift, const Matrix6d& alignment_information);

}  // namespace vsgraphs
