#include "core/loops/loop_graph.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>

#include "core/geometry/pose_covariance.h"
#include "core/loops/odometry_trust.h"

namespace vsgraphs {

namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;
constexpr int min_shared = 15;
constexpr int plenty = 100;  // shared landmarks beyond which more do not make a step firmer

Matrix6d covisible_covariance(const DriftOptions& options, int shared) {
  const double looseness = std::sqrt(static_cast<double>(plenty) / std::clamp(shared, 1, plenty));
  return isotropic_covariance(looseness * options.step_m, looseness * options.step_deg * rad_per_deg);
}

Matrix6d gap_covariance(const DriftOptions& options, const Se3& a_from_b) {
  const double sigma_m = 0.05 + options.gap_share * a_from_b.translation().norm();
  return isotropic_covariance(sigma_m,
                              2 * rad_per_deg + options.gap_share * rotation_angle(a_from_b.rotation()));
}

// Directions tracking could not see are known as badly as across a gap.
Matrix6d link_covariance(const DriftOptions& options, const TrackedLink& link, const Se3& step) {
  const Matrix6d measured = covariance_of(link.information + information_of(gap_covariance(options, step)));
  return measured + isotropic_covariance(options.step_m + options.link_share * step.translation().norm(),
                                         options.step_deg * rad_per_deg +
                                             options.link_share * rotation_angle(step.rotation()));
}

class Builder {
 public:
  Builder(const Map& map, const DriftOptions& options)
      : map_(map), options_(options), contradicted_(contradicted_steps(map, options)) {
    graph_.position.assign(map.keyframes().index_bound(), -1);
    map.keyframes().for_each([this](KeyframeId id, const Keyframe&) {
      graph_.position[id.index] = static_cast<int>(graph_.keyframes.size());
      graph_.keyframes.push_back(id);
    });
    root_.resize(graph_.keyframes.size());
    std::iota(root_.begin(), root_.end(), 0);
  }

  KeyframeGraph build(int strongest) {
    add_covisible(strongest);
    add_links();
    add_contradicted_steps();
    bridge_gaps();
    return std::move(graph_);
  }

 private:
  struct Pair {
    int a, b, shared;
    int rank;  // among a's or b's neighbours, the better of the two; 0: strongest
  };
  const Keyframe& keyframe(int position) const {
    return *map_.keyframes().find(graph_.keyframes[static_cast<std::size_t>(position)]);
  }
  Se3 relative(int a, int b) const {
    return keyframe(a).world_from_camera.inverse() * keyframe(b).world_from_camera;
  }
  // Null where none was measured from `a` to `b`.
  const OdometryStep* step_between(int a, int b) const {
    const auto& step = keyframe(b).odometry;
    return step && step->before == graph_.keyframes[static_cast<std::size_t>(a)] ? &*step : nullptr;
  }
  KeyframeEdge edge_of(int a, int b, int shared, const Matrix6d& covariance) const {
    const OdometryStep* step = step_between(a, b);
    if (!step || (shared > 0 && !contradicted(b))) return {a, b, shared, relative(a, b), covariance};
    return {a, b, shared, step->before_from_camera, floored(step->covariance, covariance)};
  }
  int root_of(int i) {
    int& parent = root_[static_cast<std::size_t>(i)];
    if (parent != i) parent = root_of(parent);
    return parent;
  }
  bool join(int a, int b) {
    const int from = root_of(b), to = root_of(a);
    if (from == to) return false;
    root_[static_cast<std::size_t>(from)] = to;
    return true;
  }

  bool contradicted(int b) const {
    return contradicted_[graph_.keyframes[static_cast<std::size_t>(b)].index] != 0;
  }
  // Within a run that the map has bent, only what was measured counts.
  bool bent(int a, int b) const {
    if (b - a > longest_run || step_between(a, b)) return false;
    for (int i = a + 1; i <= b; ++i)
      if (contradicted(i)) return true;
    return false;
  }

  // Each pair once, most shared landmarks first.
  std::vector<Pair> covisible_pairs() const {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < graph_.keyframes.size(); ++i) {
      int rank = 0;
      for (const auto& [other, shared] : map_.covisible(graph_.keyframes[i], min_shared)) {
        const int a = static_cast<int>(i), b = graph_.position_of(other);
        pairs.push_back({std::min(a, b), std::max(a, b), shared, rank++});
      }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
      return std::tie(y.shared, x.a, x.b, x.rank) < std::tie(x.shared, y.a, y.b, y.rank);
    });
    const auto same = [](const Pair& x, const Pair& y) { return x.a == y.a && x.b == y.b; };
    pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
    return pairs;
  }

  void add_covisible(int strongest) {
    for (const Pair& p : covisible_pairs()) {
      if (bent(p.a, p.b)) continue;
      const bool in_tree = join(p.a, p.b);
      if (!in_tree && p.rank >= strongest) continue;
      graph_.edges.push_back(edge_of(p.a, p.b, p.shared, covisible_covariance(options_, p.shared)));
    }
  }

  void add_links() {
    for (int b = 0; b < static_cast<int>(graph_.keyframes.size()); ++b) {
      const auto link = map_.living_link(graph_.keyframes[static_cast<std::size_t>(b)]);
      const int a = link ? graph_.position_of(link->to) : -1;
      if (a < 0) continue;
      graph_.edges.push_back(
          {a, b, 0, link->to_from_camera, link_covariance(options_, *link, link->to_from_camera)});
      join(a, b);
    }
  }

  // Those of keyframes that share too little to be joined by it.
  void add_contradicted_steps() {
    for (int b = 0; b < static_cast<int>(graph_.keyframes.size()); ++b) {
      if (!contradicted(b)) continue;
      const int a = graph_.position_of(keyframe(b).odometry->before);
      if (join(a, b)) graph_.edges.push_back(edge_of(a, b, 0, covisible_covariance(options_, 1)));
    }
  }

  void bridge_gaps() {
    std::vector<int> in_time(graph_.keyframes.size());
    std::iota(in_time.begin(), in_time.end(), 0);
    std::stable_sort(in_time.begin(), in_time.end(),
                     [this](int a, int b) { return keyframe(a).frame_index < keyframe(b).frame_index; });
    for (std::size_t i = 1; i < in_time.size(); ++i) {
      const int a = in_time[i - 1], b = in_time[i];
      if (!join(a, b)) continue;
      const bool measured = step_between(a, b) != nullptr;
      graph_.edges.push_back(edge_of(
          a, b, 0, measured ? covisible_covariance(options_, 1) : gap_covariance(options_, relative(a, b))));
    }
  }

  const Map& map_;
  const DriftOptions& options_;
  std::vector<std::uint8_t> contradicted_;  // by keyframe index: the step to it
  KeyframeGraph graph_;
  std::vector<int> root_;
};

// Per keyframe its edges, as indices.
std::vector<std::vector<int>> edges_of(const KeyframeGraph& graph) {
  std::vector<std::vector<int>> of(graph.keyframes.size());
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    of[static_cast<std::size_t>(graph.edges[e].a)].push_back(static_cast<int>(e));
    of[static_cast<std::size_t>(graph.edges[e].b)].push_back(static_cast<int>(e));
  }
  return of;
}

// The edges from `from` to `to` whose variances, metres and radians alike, add up to least.
std::vector<int> least_noise_way(const KeyframeGraph& graph, int from, int to) {
  const auto edges = edges_of(graph);
  std::vector<double> cost(graph.keyframes.size(), std::numeric_limits<double>::infinity());
  std::vector<int> by(graph.keyframes.size(), -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  cost[static_cast<std::size_t>(from)] = 0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const auto [so_far, here] = open.top();
    open.pop();
    if (so_far > cost[static_cast<std::size_t>(here)]) continue;
    if (here == to) break;
    for (const int e : edges[static_cast<std::size_t>(here)]) {
      const KeyframeEdge& edge = graph.edges[static_cast<std::size_t>(e)];
      const int there = edge.a == here ? edge.b : edge.a;
      const double total = so_far + edge.covariance.trace();
      if (total >= cost[static_cast<std::size_t>(there)]) continue;
      cost[static_cast<std::size_t>(there)] = total;
      by[static_cast<std::size_t>(there)] = e;
      open.emplace(total, there);
    }
  }
  std::vector<int> way;
  for (int at = to; at != from;) {
    const int e = by[static_cast<std::size_t>(at)];
    const KeyframeEdge& edge = graph.edges[static_cast<std::size_t>(e)];
    way.push_back(e);
    at = edge.a == at ? edge.b : edge.a;
  }
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace

KeyframeGraph graph_of(const Map& map, const DriftOptions& options, int strongest) {
  return Builder(map, options).build(strongest);
}

std::optional<Drift> drift_between(const KeyframeGraph& graph, const DriftOptions& options, KeyframeId a,
                                   KeyframeId b) {
  const int from = graph.position_of(a), to = graph.position_of(b);
  if (from < 0 || to < 0) return std::nullopt;
  Drift drift;
  int at = from;
  for (const int e : least_noise_way(graph, from, to)) {
    const KeyframeEdge& edge = graph.edges[static_cast<std::size_t>(e)];
    const bool forward = edge.a == at;
    const Se3 step = forward ? edge.a_from_b : edge.a_from_b.inverse();
    const Matrix6d noise = forward ? edge.covariance : inverted_covariance(edge.a_from_b, edge.covariance);
    drift.covariance = compose_covariance(drift.covariance, step, noise);
    drift.way_m += edge.a_from_b.translation().norm();
    drift.turn_rad += rotation_angle(edge.a_from_b.rotation());
    at = forward ? edge.b : edge.a;
  }
  drift.covariance += isotropic_covariance(
      options.share_of_way * drift.way_m,
      options.turn_deg_per_m * rad_per_deg * drift.way_m + options.share_of_turn * drift.turn_rad);
  return drift;
}

}  // namespace vsgraphs
