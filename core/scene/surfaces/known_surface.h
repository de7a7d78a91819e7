// What keyframes have said of one mapped plane: where it was seen, where rays ended on it or passed it, from where, and what a
// segmenter called it. Held in pieces, one per stretch of keyframes and in the stretch's frame, so that a loop makes
// nothing of it anew; `whole` is their sum in the world, and moves along as long as the pieces do not move against each other.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/map/ids.h"
#include "core/map/surface_patch.h"
#include "core/scene/surfaces/plane_evidence.h"

namespace vsgraphs {

// Where each stretch's frame stands: world_from_stretch by the stretch's name.
using StretchPoses = std::map<KeyframeId, Se3>;

// Of a segmenter: sums of confidences by role and by the segmenter's own classes.
struct SurfaceVotes {
  RoleVotes roles{};
  ClassVotes classes;
};

struct SurfacePiece {
  PlaneExtent extent;
  PlaneEvidence evidence;
  Eigen::Vector3d cameras = Eigen::Vector3d::Zero();  // sum of those that observe the plane
  Eigen::Vector3d middles = Eigen::Vector3d::Zero();  // sum of the patches' middles
  int keyframes = 0, patches = 0;
};
template <FieldsOf<SurfacePiece> T>
void visit_fields(T& v, auto& field) {
  auto& [extent, evidence, cameras, middles, keyframes, patches] = v;
  field(extent, evidence, cameras, middles, keyframes, patches);
}

class KnownSurface {
 public:
  // Pieces that moved against each other by more than this where they were seen are put together anew.
  static constexpr double tolerance_m = 0.05;

  // --- what is known, in the world ---
  const PlaneExtent& extent() const { return extent_; }
  const PlaneEvidence& evidence() const { return evidence_; }
  const RoleVotes& votes() const { return votes_.roles; }
  const ClassVotes& class_votes() const { return votes_.classes; }
  double largest_patch_m2() const { return largest_m2_; }
  int keyframes() const;
  // Means over the keyframes that observe it, and over their patches. Linear in the stretches.
  Eigen::Vector3d mean_camera(const StretchPoses& stretches) const;
  Eigen::Vector3d mean_middle(const StretchPoses& stretches) const;
  // A ball that holds all that was seen of it; as of the last update.
  const Eigen::Vector3d& centre() const { return centre_; }
  double radius_m() const { return radius_m_; }
  const std::map<KeyframeId, SurfacePiece>& pieces() const { return pieces_; }

  // --- what follows from edits; afterwards settle() ---
  // A piece for the stretch, if there is none; a first one takes its axes from the plane.
  void open_piece(KeyframeId stretch, const StretchPoses& stretches, const AnchoredPlane& plane,
                  const std::optional<Eigen::Vector3d>& up);
  // A patch of a keyframe of the stretch; `sign` -1 takes it out again.
  void count_patch(KeyframeId stretch, const Se3& stretch_from_camera, const SurfacePatch& patch,
                   const StretchPoses& stretches, int sign);
  void count_keyframe(KeyframeId stretch, const Se3& stretch_from_camera, int sign);
  void count_votes(const SurfaceVotes& votes, float sign);
  void set_largest_patch(double area_m2) { largest_m2_ = area_m2; }
  void count_rays(KeyframeId stretch, const MetRays& rays, const StretchPoses& stretches, bool observes_it);
  // Evidence and extents of a plane that turned out to be this one.
  void take_over(const KnownSurface& other, const StretchPoses& stretches);
  // Patches were taken out since it was settled: the whole does not know it yet.
  bool lost_patches() const { return lost_patches_; }
  // Brings the whole to where the stretches stand, and to what the pieces are. True if pieces had moved against each other.
  bool settle(const StretchPoses& stretches);

  // Of one that was read: whether its parts belong together.
  bool fits_together() const;

  template <FieldsOf<KnownSurface> T>
  friend void visit_fields(T& v, auto& field) {
    field(v.pieces_, v.extent_, v.evidence_, v.reference_, v.placed_, v.votes_.roles, v.largest_m2_,
          v.centre_, v.radius_m_);
    field.since(5, v.votes_.classes);
  }

 private:
  bool pieces_agree(const StretchPoses& stretches) const;
  void put_together(const StretchPoses& stretches);
  void find_ball();

  std::map<KeyframeId, SurfacePiece> pieces_;  // by stretch, in its frame
  PlaneExtent extent_;                         // of all
  PlaneEvidence evidence_;
  KeyframeId reference_;              // the stretch with which the whole moves
  std::map<KeyframeId, Se3> placed_;  // reference_from_stretch, as the whole was put together
  SurfaceVotes votes_;
  double largest_m2_ = 0;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double radius_m_ = 0;
  bool lost_patches_ = false;
};

}  // namespace vsgraphs
