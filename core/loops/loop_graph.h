// The map seen as a graph: which keyframes hold one another in place, and how firmly. What a loop's correction is spread
// over, and what says how far the map can have drifted between two places.
#pragma once

#include <optional>
#include <vector>

#include "core/base/options.h"
#include "core/map/map.h"

namespace vsgraphs {

// One sigma of what tracking and mapping get wrong from one keyframe to the next. Two parts: noise, new at every step, and
// a share that is wrong the same way at all of them (calibration, a lag between colour and depth) and so grows with the way.
struct DriftOptions {
  double step_m = 0.005;
  double step_deg = 0.1;
  double share_of_way = 0.004;
  double turn_deg_per_m = 0.02;
  double share_of_turn = 0.01;
  double link_share = 0.1;
  double gap_share = 0.2;
};

template <typename Visitor>
void describe(DriftOptions& o, Visitor& field) {
  field("step_m", o.step_m, 1e-4, 1.0,
        "standard deviation of a keyframe's position relative to its neighbour, in metres");
  field("step_deg", o.step_deg, 1e-3, 45.0,
        "standard deviation of a keyframe's orientation relative to its neighbour, in degrees");
  field("share_of_way", o.share_of_way, 0.0, 1.0,
        "standard deviation of the position's drift, as a share of the distance travelled");
  field("turn_deg_per_m", o.turn_deg_per_m, 0.0, 45.0,
        "standard deviation of the orientation's drift, in degrees per metre travelled");
  field("share_of_turn", o.share_of_turn, 0.0, 1.0,
        "standard deviation of the orientation's drift, as a share of the angle turned");
  field("link_share", o.link_share, 0.0, 1.0,
        "drift as a share of the step between two keyframes that surfaces alone connect");
  field("gap_share", o.gap_share, 0.01, 1.0,
        "drift as a share of the step between two consecutive keyframes that nothing connects");
}

struct KeyframeEdge {
  int a = 0, b = 0;  // positions in KeyframeGraph::keyframes
  int shared = 0;    // landmarks; 0: a tracked link, or keyframes that merely follow each other
  Se3 a_from_b;      // as odometry or tracking measured it, else as the map has it
  Matrix6d covariance = Matrix6d::Zero();  // of its noise, tangent on the right of a_from_b
};

struct KeyframeGraph {
  std::vector<KeyframeId> keyframes;  // in id order
  std::vector<KeyframeEdge> edges;
  std::vector<int> position;  // by keyframe index; -1 where there is none

  int position_of(KeyframeId id) const { return id.index < position.size() ? position[id.index] : -1; }
};

// Every keyframe with its `strongest` neighbours among those that share at least 15 landmarks, the tree of most shared
// landmarks, the tracked links, and, where that leaves it in pieces, edges between keyframes that follow each other in time.
// Where the map contradicts the odometry that was measured (odometry_trust.h), its poses are not asked: an edge there is what was
// measured, never believed to be firmer than one of the map's, so that a correction that was wrong does not hold itself up.
// Connected. Cost: one visit per pair of observations of a landmark, 0.1 s for 2,000 keyframes.
KeyframeGraph graph_of(const Map& map, const DriftOptions& options, int strongest = 5);

// What the map knows of where `b` stands as seen from `a`, along the way that adds least noise.
struct Drift {
  double way_m = 0;
  double turn_rad = 0;
  Matrix6d covariance = Matrix6d::Zero();  // tangent on the right of a_from_b
};
// Empty if either is not in the graph. Cost: Dijkstra's, edges x log keyframes.
std::optional<Drift> drift_between(const KeyframeGraph& graph, const DriftOptions& options, KeyframeId a,
                                   KeyframeId b);

}  // namespace vsgraphs
