// Minimum cut of a small directed graph: the cheapest way to tell inside from outside when every node and every edge has a
// price. Augmenting shortest paths: Edmonds, Karp, "Theoretical Improvements in Algorithmic Efficiency for Network
// Flow Problems", JACM 1972. For a few hundred nodes.
#pragma once

#include <vector>

namespace vsgraphs {

class MinCut {
 public:
  explicit MinCut(int nodes) : edges_of_(static_cast<std::size_t>(nodes) + 2), nodes_(nodes) {}

  // Prices of a node's being inside and outside, not negative.
  void add_node_cost(int node, double inside, double outside);
  // Price of `a` being inside while `b` is outside, and the other way round.
  void add_edge_cost(int a, int b, double a_inside, double b_inside);

  // 1 for nodes inside. Of equally cheap cuts the one with the fewest nodes inside.
  std::vector<char> solve();

 private:
  struct Edge {
    int to;
    double capacity;
  };
  void add(int from, int to, double capacity, double back);
  // Edge that leads to each node on a shortest path from the source, -1 where none does.
  std::vector<int> reach() const;

  std::vector<Edge> edges_;  // an edge and its reverse are neighbours: i and i ^ 1
  std::vector<std::vector<int>> edges_of_;
  int nodes_;
};

}  // namespace vsgraphs
