// What a surface is, from geometry alone: how it stands, how large it is, how high it reaches, and where rays pass it.
// No network is needed. Rules in the words of people who look at rooms; each is tested on its own.
#pragma once

#include <optional>

#include "core/base/options.h"
#include "core/geometry/plane.h"
#include "core/map/surface_patch.h"
#include "core/scene/surfaces/plane_evidence.h"

namespace vsgraphs {

struct PlaneRoleOptions {
  double max_tilt_rad = 0.2;
  double min_wall_area_m2 = 0.4;
  double sure_wall_area_m2 = 1.0;
  double min_wall_height_m = 0.8;
  double wall_top_m = 2.15;
  double open_share = 0.4;
  double leaf_width_m = 1.2;
  double min_ground_area_m2 = 0.5;
  double step_height_m = 0.15;
  int min_observations = 2;
};

template <typename Visitor>
void describe(PlaneRoleOptions& o, Visitor& field) {
  field("max_tilt_rad", o.max_tilt_rad, 0.01, 0.7,
        "largest tilt of a wall from upright and of ground from level, in radians");
  field("min_wall_area_m2", o.min_wall_area_m2, 0.0, 10.0,
        "smallest upright surface that can be a wall, in square metres");
  field("sure_wall_area_m2", o.sure_wall_area_m2, 0.0, 10.0,
        "an upright surface smaller than this, in square metres, is a wall only after more than "
        "min_observations keyframes");
  field("min_wall_height_m", o.min_wall_height_m, 0.0, 3.0,
        "least height over which a wall must be seen, in metres, unless it reaches up to wall_top_m");
  field("wall_top_m", o.wall_top_m, 1.0, 4.0,
        "an upright surface whose top is seen to end below this height above the ground, in metres, is no "
        "wall");
  field("open_share", o.open_share, 0.05, 1.0,
        "share of a surface's edge that rays must pass for the edge to count as seen");
  field("leaf_width_m", o.leaf_width_m, 0.0, 3.0,
        "an upright surface narrower than this, in metres, with an open side is a wall only once it reaches "
        "wall_top_m");
  field("min_ground_area_m2", o.min_ground_area_m2, 0.0, 10.0,
        "smallest level surface that can be ground, in square metres");
  field("step_height_m", o.step_height_m, 0.02, 1.0,
        "a level surface this much above the lowest ground, in metres, is a step or a table");
  field("min_observations", o.min_observations, 1, 20,
        "number of keyframes that must have seen a surface before its role is decided");
}

// How the visible outline of an upright surface ends, and how large it is.
struct UprightShape {
  double area_m2 = 0, width_m = 0;
  double low_m = 0, high_m = 0;          // along t of the frame, 5 % and 95 % of the columns' ends
  double open_top_share = 0;             // of the columns, that end in open cells above
  double open_top_m = 0;                 // where those end: their median
  double open_left = 0, open_right = 0;  // share of the side's height that is passed
};
UprightShape shape_of(const PlaneEvidence& evidence);

// Share of the outline's cells beside which rays pass to something lower.
double open_outline_share(const PlaneEvidence& evidence);

struct SurfaceFacts {
  Eigen::Vector3d normal;                 // world
  int observations = 0;                   // keyframes
  double height_m = 0;                    // of the surface's middle along `up`
  std::optional<double> ground_height_m;  // of the nearest ground below it, along `up`
  std::optional<double> lowest_level_m;   // of the lowest level surface known, along `up`
  double camera_height_m = 0;             // mean of the cameras that saw it, along `up`
};

// Over how much of a surface's width a larger one beside its plane, facing the same way, is seen above or below it: then
// the larger one is the wall, and this is a cabinet, a radiator or a curtain before it, or a pane in an opening of it.
double width_shared_with(const PlaneEvidence& surface, const PlaneEvidence& larger);
// Over how much of its width a surface stands before or behind the stretch from the larger one's one end to its other.
double width_within(const PlaneEvidence& surface, const PlaneEvidence& larger);

// How far the surface's farthest seen point lies from a plane, m; 0 if nothing of it was seen.
double farthest_from(const AnchoredPlane& plane, const PlaneEvidence& surface);

struct JudgedSurface {
  const AnchoredPlane& plane;
  const PlaneEvidence& evidence;
};
// Whether a larger surface close to an upright one is the wall, and this a thing before or in it: the larger one shows
// above or below it; or it goes on to both sides and nothing of this one, which may be turned a little as the folds of a
// curtain are, is farther than a hand from it.
bool larger_is_the_wall(const JudgedSurface& surface, const JudgedSurface& larger, double max_angle_rad);

// `undecided` where too little is known.
SurfaceRole role_by_geometry(const SurfaceFacts& facts, const PlaneEvidence& evidence,
                             const Eigen::Vector3d& up, const PlaneRoleOptions& options);

// Which roles a surface can have at all, as it stands: a level one is no wall, whatever a network says.
bool stance_allows(SurfaceRole role, const Eigen::Vector3d& normal, const Eigen::Vector3d& up,
                   double max_tilt_rad);

}  // namespace vsgraphs
