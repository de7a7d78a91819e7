// Which mapped plane a keyframe's patch belongs to. Class plays no part in it: votes can change what a plane is, not
// which plane it is. Condition after the paper (vS-Graphs, "Structural Element Recognition": distance and angle between
// building components), with the distance taken at the patch, not at a far-away origin, and with extents.
#pragma once

#include <vector>

#include "core/base/options.h"
#include "core/map/map.h"
#include "core/scene/surfaces/surface_keeper.h"

namespace vsgraphs {

struct PlaneAssociationOptions {
  double max_angle_rad = 0.15;
  double max_offset_m = 0.12;
  double max_gap_m = 1.5;
  double same_view_offset_m = 0.03;
  double merge_angle_rad = 0.06;
  double merge_offset_m = 0.06;
  double merge_gap_m = 1.5;
  double min_thickness_m = 0.05;
  double max_thickness_m = 0.6;
};

template <typename Visitor>
void describe(PlaneAssociationOptions& o, Visitor& field) {
  field("max_angle_rad", o.max_angle_rad, 0.01, 0.8,
        "largest angle between a patch and the plane it is associated with, in radians");
  field("max_offset_m", o.max_offset_m, 0.01, 1.0,
        "largest distance from a patch's middle to the plane it is associated with, in metres");
  field("max_gap_m", o.max_gap_m, 0.0, 10.0,
        "largest gap between a patch and the observed extent of its plane, in metres");
  field("same_view_offset_m", o.same_view_offset_m, 0.0, 0.5,
        "largest offset between two patches of one keyframe that belong to one plane, in metres");
  field("merge_angle_rad", o.merge_angle_rad, 0.005, 0.5,
        "largest angle between two planes that are merged, in radians");
  field("merge_offset_m", o.merge_offset_m, 0.005, 0.5,
        "largest distance from one plane's middle to another plane that it is merged with, in metres");
  field("merge_gap_m", o.merge_gap_m, 0.0, 10.0,
        "largest gap between the extents of two planes that are merged, in metres");
  field("min_thickness_m", o.min_thickness_m, 0.0, 0.5,
        "least thickness of a wall whose two faces are paired, in metres");
  field("max_thickness_m", o.max_thickness_m, 0.05, 2.0,
        "greatest thickness of a wall whose two faces are paired, in metres");
}

// A patch in the world.
struct PlacedPatch {
  AnchoredPlane plane;
  double tilt_sigma_rad = 0;            // the less certain one
  std::vector<Eigen::Vector3d> points;  // in the world
};
PlacedPatch place(const SurfacePatch& patch, const Se3& world_from_camera);

// --- the rules, each by itself ---
bool faces_the_same_way(const AnchoredPlane& a, const AnchoredPlane& b, double max_angle_rad);
// The distance is taken at `patch`'s anchor.
bool offset_agrees(const AnchoredPlane& plane, const AnchoredPlane& patch, double max_offset_m);
// Some of the patch lies within the gap of the extent.
bool extents_touch(const PlaneExtent& extent, const std::vector<Eigen::Vector3d>& points, double max_gap_m);

// `surfaces` is what is known of the map's planes.

// For each patch of a keyframe its plane, invalid where it shows a new one.
std::vector<PlaneId> associate_patches(const Map& map, const SurfaceKeeper& surfaces,
                                       const std::vector<PlacedPatch>& patches,
                                       const PlaneAssociationOptions& options);

// Pairs (gone, kept) of planes that turned out to be one; the one observed more often stays. Those among `touched`
// are held against all others.
struct PlaneMerge {
  PlaneId gone, kept;
};
std::vector<PlaneMerge> find_merges(const Map& map, const SurfaceKeeper& surfaces,
                                    const std::set<PlaneId>& touched, const PlaneAssociationOptions& options);

// Opposite faces back to back within the thickness of a wall, over each other in part. Empty if none fits; the nearest
// of those that do.
struct OtherFace {
  PlaneId id;
  double thickness_m = 0;
};
std::optional<OtherFace> find_other_face(const Map& map, const SurfaceKeeper& surfaces, PlaneId face,
                                         const PlaneAssociationOptions& options);

}  // namespace vsgraphs
