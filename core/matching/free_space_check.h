// Whether what one view shows stands where another one looked through to something behind. Depth grids are compared, planes
// or not, so that it needs no understanding of the scene; two rooms that look alike seldom pass.
#pragma once

#include <vector>

#include "core/geometry/camera.h"
#include "core/map/map.h"
#include "core/vision/depth_sampling.h"

namespace vsgraphs {

struct FreeSpaceCount {
  int seen = 0;     // samples where the witness has a reading, in front of it or on it
  int through = 0;  // of those, in front
  FreeSpaceCount& operator+=(const FreeSpaceCount& other) {
    seen += other.seen;
    through += other.through;
    return *this;
  }
};

// Of what `source` shows, how much the witness looked through. `tolerance_m`: by which a sample may be off, beside the sensor's
// noise. Cost: 0.02 to 0.1 ms.
FreeSpaceCount count_seen_through(const DepthSampler& sampler, const DepthNoise& noise,
                                  const DepthGrid& source, const DepthGrid& witness,
                                  const Se3& witness_from_source, double tolerance_m);

// How far off things may be.
struct Slack {
  double least_m = 0.15;
  double share = 0;  // of the distance from `centre`: maps drift
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};
// Of the surfaces that `from` saw (moved by `correction`, world from world), how many `to` looked through; all with all.
FreeSpaceCount count_seen_through(const Map& map, const Camera& camera, const std::vector<KeyframeId>& from,
                                  const Se3& correction, const std::vector<KeyframeId>& to,
                                  const Slack& slack = {});

// Of what `from` saw, how much a frame at that pose looks through.
FreeSpaceCount count_seen_through(const Map& map, const DepthSampler& sampler, const DepthNoise& noise,
                                  const std::vector<KeyframeId>& from, const DepthGrid& frame,
                                  const Se3& world_from_frame);

}  // namespace vsgraphs
