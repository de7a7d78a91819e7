#include "core/scene/rooms/min_cut.h"

#include <algorithm>
#include <limits>

namespace vsgraphs {
namespace {

constexpr double exhausted = 1e-9;

}  // namespace

void MinCut::add(int from, int to, double capacity, double back) {
  edges_of_[static_cast<std::size_t>(from)].push_back(static_cast<int>(edges_.size()));
  edges_.push_back({to, capacity});
  edges_of_[static_cast<std::size_t>(to)].push_back(static_cast<int>(edges_.size()));
  edges_.push_back({from, back});
}

void MinCut::add_node_cost(int node, double inside, double outside) {
  const int source = nodes_, sink = nodes_ + 1;
  add(source, node, outside, 0);
  add(node, sink, inside, 0);
}

void MinCut::add_edge_cost(int a, int b, double a_inside, double b_inside) { add(a, b, a_inside, b_inside); }

std::vector<int> MinCut::reach() const {
  const int source = nodes_;
  std::vector<int> by(edges_of_.size(), -1), queue{source};
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (const int e : edges_of_[static_cast<std::size_t>(queue[i])]) {
      const Edge& edge = edges_[static_cast<std::size_t>(e)];
      if (edge.capacity <= exhausted || edge.to == source || by[static_cast<std::size_t>(edge.to)] >= 0)
        continue;
      by[static_cast<std::size_t>(edge.to)] = e;
      queue.push_back(edge.to);
    }
  return by;
}

std::vector<char> MinCut::solve() {
  const int source = nodes_, sink = nodes_ + 1;
  std::vector<int> by = reach();
  while (by[static_cast<std::size_t>(sink)] >= 0) {
    double flow = std::numeric_limits<double>::infinity();
    const auto along_path = [&](auto&& visit) {
      for (int node = sink; node != source;) {
        const int e = by[static_cast<std::size_t>(node)];
        visit(e);
        node = edges_[static_cast<std::size_t>(e ^ 1)].to;
      }
    };
    along_path([&](int e) { flow = std::min(flow, edges_[static_cast<std::size_t>(e)].capacity); });
    along_path([&](int e) {
      edges_[static_cast<std::size_t>(e)].capacity -= flow;
      edges_[static_cast<std::size_t>(e ^ 1)].capacity += flow;
    });
    by = reach();
  }
  std::vector<char> inside(static_cast<std::size_t>(nodes_));
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = by[i] >= 0;
  return inside;
}

}  // namespace vsgraphs
