// How what is known of the planes goes to an archive and comes back.
#include <algorithm>

#include "core/geometry/bounds.h"
#include "core/scene/surfaces/surface_keeper.h"

namespace vsgraphs {

void SurfaceKeeper::save(ArchiveWriter& archive, const std::string& section) const {
  archive.add(section, known_, told_, stretches_, up_);
}

bool SurfaceKeeper::adopt(const Follower& known) {
  const DepthNoise noise = noise_;
  *this = dynamic_cast<const SurfaceKeeper&>(known);
  noise_ = noise;
  return true;
}

void SurfaceKeeper::load(const ArchiveReader& archive, const std::string& section) {
  *this = SurfaceKeeper(noise_);
  archive.read(section, known_, told_, stretches_, up_);
}

namespace {

bool is_frame(const PlaneFrame& frame) {
  return within(frame.origin, 2 * most_metres) && is_unit(frame.s) && is_unit(frame.t) &&
         within(frame.s.dot(frame.t), 1e-3);
}

bool are_sane(const RoleVotes& votes) {
  return std::all_of(votes.begin(), votes.end(),
                     [](float vote) { return within(static_cast<double>(vote), most_information); });
}

Wrong wrong_with(const KnownSurface& known, const StretchPoses& stretches) {
  if (!known.fits_together()) return "surfaces that do not fit together";
  if (!is_frame(known.extent().frame()) || !is_frame(known.evidence().frame()))
    return "a surface that is nowhere";
  if (!are_sane(known.votes()) || !are_sane(known.class_votes()) ||
      !within(known.largest_patch_m2(), most_metres * most_metres) ||
      !within(known.centre(), 2 * most_metres) || !within(known.radius_m(), 2 * most_metres))
    return "a surface of no size";
  for (const auto& [stretch, piece] : known.pieces()) {
    if (!stretches.contains(stretch)) return "a surface seen from nowhere";
    if (!is_frame(piece.extent.frame()) || !is_frame(piece.evidence.frame()) || piece.keyframes < 0 ||
        piece.patches < 0 || !within(piece.cameras, 1e12) || !within(piece.middles, 1e12))
      return "a surface that is nowhere";
  }
  return nullptr;
}

}  // namespace

Wrong SurfaceKeeper::wrong_with(const Map& map) const {
  for (const auto& [stretch, pose] : stretches_) {
    if (map.stretch_of(stretch) != stretch || !is_pose(pose))
      return "surfaces of a stretch that does not exist";
  }
  for (const auto& [id, known] : known_) {
    if (!map.planes().contains(id)) return "what is known of a plane that does not exist";
    if (Wrong wrong = vsgraphs::wrong_with(known, stretches_)) return wrong;
    if (!are_named(known.class_votes(), map.class_names())) return "a surface of a class without a name";
  }
  for (const auto& [id, told] : told_) {
    const std::size_t patches = told.patches ? told.patches->patches.size() : 0;
    // What the map holds was checked with the map.
    if (told.patches && told.patches != map.patches_of(id)) return "surfaces of patches that no keyframe has";
    const bool there = std::all_of(told.sights.begin(), told.sights.end(), [&](const Sight& s) {
      return s.patch < patches && known_.contains(s.plane) &&
             known_.at(s.plane).pieces().contains(map.stretch_of(id));
    });
    if (!map.retired_keyframes().contains(id) || !there || !is_pose(told.stretch_from_camera))
      return "a keyframe that saw what does not exist";
  }
  const auto& all = map.keyframes();
  for (std::uint32_t index = 0; index < all.index_bound(); ++index) {
    const KeyframeId id = all.at_index(index);
    if (id.valid() && !stretches_.contains(map.stretch_of(id)))
      return "a stretch of which no surfaces are known";
  }
  return up_ && !is_unit(*up_) ? "surfaces of no upward direction" : nullptr;
}

}  // namespace vsgraphs
