#include "core/matching/descriptor_alignment.h"

#include <algorithm>

#include "core/solve/align_matches.h"
#include "core/vision/matching.h"

namespace vsgraphs {

std::vector<Correspondence> DescriptorAligner::match(const Map& map, const PosedView& there,
                                                     const FeatureSet& now) const {
  MatchOptions options;
  options.max_distance = 64;
  options.ratio = 0.85;
  options.check_rotation = true;
  std::vector<Correspondence> candidates;
  for (const auto& [theirs, ours] : match_descriptors(there.features, now, options)) {
    const LandmarkId id = there.landmarks[static_cast<std::size_t>(theirs)];
    const Landmark* landmark = map.landmarks().find(id);
    const Feature& seen = there.features[theirs];
    if (landmark) {
      candidates.push_back({ours, id, landmark->point_in_world});
    } else if (seen.has_depth()) {
      candidates.push_back(
          {ours, LandmarkId{}, there.world_from_camera * camera_.unproject(seen.u, seen.v, seen.depth_m)});
    }
  }
  return candidates;
}

std::optional<MatchedPose> DescriptorAligner::align(const Map& map, const PosedView& there,
                                                    const FeatureSet& now, int min_inliers, Rng rng) const {
  MatchedPose found;
  found.matches.reset(now.size());
  for (const Correspondence& candidate : match(map, there, now)) found.matches.add(candidate);
  if (found.matches.size() < min_inliers) return std::nullopt;
  AlignMatchesOptions options;
  options.min_inliers = min_inliers;
  const auto aligned = align_matches(Intrinsics::of(camera_),
                                     pose_observations(camera_, pyramid_, now, found.matches), rng, options);
  if (!aligned || aligned->degenerate) return std::nullopt;
  found.matches.keep_inliers(aligned->fit);
  found.pose = {aligned->world_from_camera, found.matches.size(), true,
                aligned->information,       aligned->information, false};
  return found;
}

}  // namespace vsgraphs
