#include "core/scene/surfaces/plane_association.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry/principal_axes.h"

namespace vsgraphs {

PlacedPatch place(const SurfacePatch& patch, const Se3& world_from_camera) {
  PlacedPatch placed;
  placed.plane = patch.plane.transformed(world_from_camera);
  const Eigen::Matrix2d tilt = patch.information.topLeftCorner<2, 2>();
  const double weakest = smallest_eigenvalue(tilt);
  placed.tilt_sigma_rad = 1 / std::sqrt(std::max(weakest, 1.0));
  placed.points.reserve(patch.points.size());
  for (const Eigen::Vector3f& p : patch.points) placed.points.push_back(world_from_camera * p.cast<double>());
  return placed;
}

bool faces_the_same_way(const AnchoredPlane& a, const AnchoredPlane& b, double max_angle_rad) {
  return a.normal.dot(b.normal) > std::cos(max_angle_rad);
}

bool offset_agrees(const AnchoredPlane& plane, const AnchoredPlane& patch, double max_offset_m) {
  return std::abs(plane.signed_distance(patch.anchor)) <= max_offset_m;
}

bool extents_touch(const PlaneExtent& extent, const std::vector<Eigen::Vector3d>& points, double max_gap_m) {
  return std::any_of(points.begin(), points.end(),
                     [&](const Eigen::Vector3d& p) { return extent.near(p, max_gap_m); });
}

namespace {

// How well a patch fits a plane, smaller is better; empty if it does not.
std::optional<double> misfit(const KnownSurface& known, const MappedPlane& mapped, const PlacedPatch& patch,
                             const PlaneAssociationOptions& options) {
  constexpr double widest_rad = 0.35;
  const double max_angle = std::min(widest_rad, options.max_angle_rad + 2 * patch.tilt_sigma_rad);
  if (!faces_the_same_way(mapped.plane, patch.plane, max_angle)) return std::nullopt;
  if (!offset_agrees(mapped.plane, patch.plane, options.max_offset_m)) return std::nullopt;
  if (!extents_touch(known.extent(), patch.points, options.max_gap_m)) return std::nullopt;
  const double angle = std::acos(std::clamp(mapped.plane.normal.dot(patch.plane.normal), -1.0, 1.0));
  return std::abs(mapped.plane.signed_distance(patch.plane.anchor)) / options.max_offset_m +
         angle / max_angle;
}

// Whether a patch may join those the plane has from the same keyframe: what one image shows as two depths is two things.
bool coplanar_with(const std::vector<const PlacedPatch*>& taken, const PlacedPatch& patch,
                   double max_offset_m) {
  return std::all_of(taken.begin(), taken.end(), [&](const PlacedPatch* other) {
    const double reach = (other->plane.anchor - patch.plane.anchor).norm();
    const double allowed = max_offset_m + reach * std::min(other->tilt_sigma_rad, patch.tilt_sigma_rad);
    return std::min(std::abs(other->plane.signed_distance(patch.plane.anchor)),
                    std::abs(patch.plane.signed_distance(other->plane.anchor))) <= allowed;
  });
}

}  // namespace

std::vector<PlaneId> associate_patches(const Map& map, const SurfaceKeeper& surfaces,
                                       const std::vector<PlacedPatch>& patches,
                                       const PlaneAssociationOptions& options) {
  struct Candidate {
    double misfit;
    std::size_t patch;
    PlaneId plane;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    map.planes().for_each([&](PlaneId id, const MappedPlane& mapped) {
      const KnownSurface* known = surfaces.find(id);
      if (!known) return;
      if (const auto m = misfit(*known, mapped, patches[i], options)) candidates.push_back({*m, i, id});
    });
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.misfit < b.misfit; });
  std::vector<PlaneId> result(patches.size());
  std::vector<std::vector<const PlacedPatch*>> taken(map.planes().index_bound());
  for (const Candidate& c : candidates) {
    if (result[c.patch].valid()) continue;
    auto& others = taken[c.plane.index];
    if (!coplanar_with(others, patches[c.patch], options.same_view_offset_m)) continue;
    result[c.patch] = c.plane;
    others.push_back(&patches[c.patch]);
  }
  return result;
}

namespace {

struct SeenPlane {
  const AnchoredPlane& plane;
  const PlaneExtent& extent;
};

bool one_surface(const SeenPlane& a, const SeenPlane& b, const PlaneAssociationOptions& options) {
  if (!faces_the_same_way(a.plane, b.plane, options.merge_angle_rad)) return false;
  // Cheap first: the anchors lie within the extents.
  constexpr double lever_m = 0.1;
  const double coarse = options.merge_offset_m + lever_m;
  if (!offset_agrees(a.plane, b.plane, coarse) && !offset_agrees(b.plane, a.plane, coarse)) return false;
  if (std::abs(a.plane.signed_distance(b.plane.project(b.extent.centre()))) > options.merge_offset_m ||
      std::abs(b.plane.signed_distance(a.plane.project(a.extent.centre()))) > options.merge_offset_m)
    return false;
  return extents_touch(a.extent, b.extent.points(), options.merge_gap_m);
}

}  // namespace

std::vector<PlaneMerge> find_merges(const Map& map, const SurfaceKeeper& surfaces,
                                    const std::set<PlaneId>& touched,
                                    const PlaneAssociationOptions& options) {
  std::vector<PlaneMerge> merges;
  std::vector<PlaneId> gone;
  const auto is_gone = [&](PlaneId id) { return std::find(gone.begin(), gone.end(), id) != gone.end(); };
  for (const PlaneId id : touched) {
    const MappedPlane* plane = map.planes().find(id);
    const KnownSurface* known = surfaces.find(id);
    if (!plane || !known) continue;
    map.planes().for_each([&](PlaneId other_id, const MappedPlane& other) {
      const KnownSurface* other_known = surfaces.find(other_id);
      if (other_id == id || !other_known || is_gone(id) || is_gone(other_id) ||
          !one_surface({plane->plane, known->extent()}, {other.plane, other_known->extent()}, options))
        return;
      const bool keep_other = other.observations.size() != plane->observations.size()
                                  ? other.observations.size() > plane->observations.size()
                                  : other_id < id;
      merges.push_back(keep_other ? PlaneMerge{id, other_id} : PlaneMerge{other_id, id});
      gone.push_back(merges.back().gone);
    });
  }
  return merges;
}

std::optional<OtherFace> find_other_face(const Map& map, const SurfaceKeeper& surfaces, PlaneId face,
                                         const PlaneAssociationOptions& options) {
  const MappedPlane* mine = map.planes().find(face);
  const KnownSurface* my_surface = surfaces.find(face);
  if (!mine || !my_surface) return std::nullopt;
  std::optional<OtherFace> best;
  map.planes().for_each([&](PlaneId id, const MappedPlane& other) {
    const AnchoredPlane turned{-other.plane.normal, other.plane.anchor, -other.plane.offset_m};
    if (id == face || other.role != mine->role ||
        !faces_the_same_way(mine->plane, turned, options.max_angle_rad))
      return;
    // Each lies behind the other.
    const double thickness = -mine->plane.signed_distance(other.plane.anchor);
    if (thickness < options.min_thickness_m || thickness > options.max_thickness_m) return;
    if (best && best->thickness_m <= thickness) return;
    constexpr double beside_m = 0.5;
    const KnownSurface* theirs = surfaces.find(id);
    if (theirs && extents_touch(my_surface->extent(), theirs->extent().points(), beside_m))
      best = OtherFace{id, thickness};
  });
  return best;
}

}  // namespace vsgraphs
