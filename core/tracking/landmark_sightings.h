// How often each landmark should have been seen, and was, since the last keyframe request: what the mapper culls by.
#pragma once

#include <unordered_map>
#include <vector>

#include "core/matching/frame_pose.h"
#include "core/matching/messages.h"

namespace vsgraphs {

class LandmarkSightings {
 public:
  // Of one frame: what it matched, and what should have been in view. With less than `min_matches` the frame was too dark or
  // too blurred to show anything and says nothing against the landmarks.
  void count(const FrameMatches& matches, const std::vector<LandmarkId>& expected, int min_matches);
  // All counts, in the order of the landmarks; counting begins anew.
  std::vector<Sighting> take();
  void clear() { counts_.clear(); }

 private:
  struct Count {
    std::uint32_t visible = 0, found = 0;
  };
  struct HashId {
    std::size_t operator()(LandmarkId id) const { return id.index ^ (std::size_t{id.generation} << 32); }
  };
  std::unordered_map<LandmarkId, Count, HashId> counts_;
};

}  // namespace vsgraphs
