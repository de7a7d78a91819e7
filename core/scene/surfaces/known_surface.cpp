#include "core/scene/surfaces/known_surface.h"

#include <algorithm>
#include <array>

#include "core/geometry/bounds.h"

namespace vsgraphs {

namespace {

MetRays transformed(const MetRays& rays, const Se3& change) {
  MetRays moved = rays;
  for (auto* points : {&moved.on, &moved.through}) {
    for (Eigen::Vector3d& point : *points) point = change * point;
  }
  return moved;
}

Eigen::Vector3d mean(const std::map<KeyframeId, SurfacePiece>& pieces, const StretchPoses& stretches,
                     Eigen::Vector3d SurfacePiece::* sums, int SurfacePiece::* counts) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto& [stretch, piece] : pieces) {
    const int n = piece.*counts;
    if (n == 0) continue;
    sum += n * (stretches.at(stretch) * Eigen::Vector3d(piece.*sums / n));
    count += n;
  }
  return sum / std::max(1, count);
}

// The corners of what was seen of a piece, in its stretch's frame.
std::array<Eigen::Vector3d, 4> corners_of(const PlaneExtent& extent) {
  const auto& cells = extent.cells();
  const double s[] = {cells.min_s() * PlaneExtent::cell_m, cells.end_s() * PlaneExtent::cell_m};
  const double t[] = {cells.min_t() * PlaneExtent::cell_m, cells.end_t() * PlaneExtent::cell_m};
  const PlaneFrame& frame = extent.frame();
  return {frame.point(s[0], t[0]), frame.point(s[1], t[0]), frame.point(s[0], t[1]), frame.point(s[1], t[1])};
}

}  // namespace

int KnownSurface::keyframes() const {
  int count = 0;
  for (const auto& [stretch, piece] : pieces_) count += piece.keyframes;
  return count;
}

Eigen::Vector3d KnownSurface::mean_camera(const StretchPoses& stretches) const {
  return mean(pieces_, stretches, &SurfacePiece::cameras, &SurfacePiece::keyframes);
}

Eigen::Vector3d KnownSurface::mean_middle(const StretchPoses& stretches) const {
  return mean(pieces_, stretches, &SurfacePiece::middles, &SurfacePiece::patches);
}

// The frame of a later piece is the whole's, so that the cells of both are the same until a loop moves one against the other.
void KnownSurface::open_piece(KeyframeId stretch, const StretchPoses& stretches, const AnchoredPlane& plane,
                              const std::optional<Eigen::Vector3d>& up) {
  if (pieces_.contains(stretch)) return;
  const Se3& world_from_stretch = stretches.at(stretch);
  if (pieces_.empty()) {
    const PlaneFrame frame = frame_of(plane, up);
    extent_ = PlaneExtent(frame);
    evidence_ = PlaneEvidence(frame);
    reference_ = stretch;
  }
  const PlaneFrame in_stretch = extent_.frame().transformed(world_from_stretch.inverse());
  pieces_[stretch] = {PlaneExtent(in_stretch), PlaneEvidence(in_stretch)};
  placed_[stretch] = stretches.at(reference_).inverse() * world_from_stretch;
}

void KnownSurface::count_patch(KeyframeId stretch, const Se3& stretch_from_camera, const SurfacePatch& patch,
                               const StretchPoses& stretches, int sign) {
  SurfacePiece& piece = pieces_.at(stretch);
  piece.middles += sign * (stretch_from_camera * patch.plane.anchor);
  piece.patches += sign;
  if (sign < 0) {
    for (const Eigen::Vector3f& p : patch.points) piece.extent.remove(stretch_from_camera * p.cast<double>());
    lost_patches_ = true;
    return;
  }
  // As the whole has it: where the stretch stood when it was put together.
  const Se3 world_from_camera = stretches.at(reference_) * placed_.at(stretch) * stretch_from_camera;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : patch.points) {
    points.push_back(world_from_camera * p.cast<double>());
    piece.extent.add(stretch_from_camera * p.cast<double>());
    extent_.add(points.back());
  }
  evidence_.expect(points);
  largest_m2_ = std::max(largest_m2_, static_cast<double>(patch.area_m2));
}

void KnownSurface::count_keyframe(KeyframeId stretch, const Se3& stretch_from_camera, int sign) {
  SurfacePiece& piece = pieces_.at(stretch);
  piece.cameras += sign * stretch_from_camera.translation();
  piece.keyframes += sign;
}

void KnownSurface::count_votes(const SurfaceVotes& votes, float sign) {
  for (std::size_t r = 0; r < surface_role_count; ++r) votes_.roles[r] += sign * votes.roles[r];
  add_votes(votes_.classes, votes.classes, sign);
}

void KnownSurface::count_rays(KeyframeId stretch, const MetRays& rays, const StretchPoses& stretches,
                              bool observes_it) {
  const MetRays counted = evidence_.count(rays, observes_it);
  pieces_.at(stretch).evidence.count_all(transformed(counted, stretches.at(stretch).inverse()));
}

void KnownSurface::take_over(const KnownSurface& other, const StretchPoses& stretches) {
  for (const auto& [stretch, theirs] : other.pieces_) {
    const auto [mine, fresh] = pieces_.try_emplace(stretch, theirs);
    if (!fresh) {
      mine->second.extent.add(theirs.extent);
      mine->second.evidence.add(theirs.evidence);
      mine->second.cameras += theirs.cameras;
      mine->second.middles += theirs.middles;
      mine->second.keyframes += theirs.keyframes;
      mine->second.patches += theirs.patches;
    }
  }
  count_votes(other.votes_, 1);
  largest_m2_ = std::max(largest_m2_, other.largest_m2_);
  const bool lost_patches = lost_patches_ || other.lost_patches_;
  put_together(stretches);
  lost_patches_ = lost_patches;
}

bool KnownSurface::settle(const StretchPoses& stretches) {
  if (pieces_.empty()) return false;
  const bool anew = !pieces_agree(stretches);
  if (anew || lost_patches_) {
    put_together(stretches);
  } else {
    const PlaneFrame frame = pieces_.at(reference_).extent.frame().transformed(stretches.at(reference_));
    extent_.set_frame(frame);
    evidence_.set_frame(frame);
  }
  find_ball();
  return anew;
}

bool KnownSurface::pieces_agree(const StretchPoses& stretches) const {
  const Se3 reference_from_world = stretches.at(reference_).inverse();
  return std::all_of(pieces_.begin(), pieces_.end(), [&](const auto& entry) {
    const auto& [stretch, piece] = entry;
    if (stretch == reference_ || piece.extent.cells().empty()) return true;
    const Se3 now = reference_from_world * stretches.at(stretch);
    const Se3& placed = placed_.at(stretch);
    const auto corners = corners_of(piece.extent);
    return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& corner) {
      return (now * corner - placed * corner).norm() <= tolerance_m;
    });
  });
}

// In the frame of the stretch that saw most of it.
void KnownSurface::put_together(const StretchPoses& stretches) {
  reference_ = std::max_element(pieces_.begin(), pieces_.end(), [](const auto& a, const auto& b) {
                 return a.second.patches < b.second.patches;
               })->first;
  const Se3& world_from_reference = stretches.at(reference_);
  const PlaneFrame frame = pieces_.at(reference_).extent.frame().transformed(world_from_reference);
  extent_ = PlaneExtent(frame);
  evidence_ = PlaneEvidence(frame);
  placed_.clear();
  lost_patches_ = false;
  for (const auto& [stretch, piece] : pieces_) {
    const Se3& world_from_stretch = stretches.at(stretch);
    placed_[stretch] = world_from_reference.inverse() * world_from_stretch;
    PlaneExtent extent = piece.extent;
    extent.set_frame(extent.frame().transformed(world_from_stretch));
    extent_.add(extent);
    PlaneEvidence evidence = piece.evidence;
    evidence.set_frame(evidence.frame().transformed(world_from_stretch));
    evidence_.add(evidence);
    evidence_.expect(extent.points());
  }
}

bool KnownSurface::fits_together() const {
  const auto same_key = [](const auto& a, const auto& b) { return a.first == b.first; };
  return pieces_.contains(reference_) &&
         std::equal(pieces_.begin(), pieces_.end(), placed_.begin(), placed_.end(), same_key) &&
         std::all_of(placed_.begin(), placed_.end(),
                     [](const auto& placed) { return is_pose(placed.second); }) &&
         extent_.fits_together() && evidence_.fits_together() &&
         std::all_of(pieces_.begin(), pieces_.end(), [](const auto& piece) {
           return piece.second.extent.fits_together() && piece.second.evidence.fits_together();
         });
}

void KnownSurface::find_ball() {
  const auto corners = corners_of(extent_);
  centre_ = 0.5 * (corners.front() + corners.back());
  radius_m_ = (corners.front() - centre_).norm();
}

}  // namespace vsgraphs
