// Free-space clusters: connected free space at eye level, cut where walls have openings and where clearance narrows to the
// width of a doorway. Rooms are made of them.
// Method: vS-Graphs, section "Structural Element Recognition"; basins of the clearance field joined by persistence as in
// Hughes, Chang, Carlone, "Hydra", RSS 2022 (rooms that persist as free space is eroded).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/options.h"
#include "core/scene/rooms/level_map.h"
#include "core/scene/rooms/openings.h"

namespace vsgraphs {

struct ClusterOptions {
  double min_area_m2 = 1.0;
  double max_island_m = 1.5;
  double min_persistence_m = 0.15;
  double narrowing = 1.5;
};

template <typename Visitor>
void describe(ClusterOptions& o, Visitor& field) {
  field("min_area_m2", o.min_area_m2, 0.1, 20.0, "smallest free space that can be a room, in square metres");
  field("max_island_m", o.max_island_m, 0.0, 5.0,
        "longest free-standing object that does not divide a room, in metres");
  field("min_persistence_m", o.min_persistence_m, 0.05, 1.0,
        "a narrow place divides rooms if clearance grows by this on both of its sides, in metres");
  field(
      "narrowing", o.narrowing, 1.0, 5.0,
      "a narrow place divides rooms if clearance grows by this factor where the walls beside it are unknown");
}

struct Cluster {
  double area_m2 = 0;
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  double max_clearance_m = 0;
  bool visited = false;  // the camera has been inside
};

struct ClusterOpening {
  WallOpening opening;
  std::array<int, 2> clusters{-1, -1};  // behind and before the normal; -1: no cluster
};

// Labels index `clusters`; -1 where there is none.
struct Clusters {
  GridValues<int> labels;
  GridValues<float> clearance_m;  // walls, openings and what reaches eye level are obstacles
  std::vector<Cluster> clusters;
  std::vector<ClusterOpening> openings;  // between two different clusters, or a cluster and nothing
};

// `cameras`: positions on this level. Costs about 10 ms for 10,000 cells.
Clusters find_clusters(const LevelMap& map, std::span<const WallLine> walls,
                       std::span<const Eigen::Vector2d> cameras, const ClusterOptions& options,
                       const OpeningOptions& opening_options);

}  // namespace vsgraphs
