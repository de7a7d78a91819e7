#include "core/scene/rooms/min_cut.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

struct Costs {
  std::vector<std::array<double, 2>> nodes;  // inside, outside
  std::vector<std::array<double, 2>> edges;  // first inside, second inside
  std::vector<std::array<int, 2>> ends;

  double of(const std::vector<char>& inside) const {
    double sum = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) sum += nodes[i][inside[i] ? 0 : 1];
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const char a = inside[static_cast<std::size_t>(ends[e][0])],
                 b = inside[static_cast<std::size_t>(ends[e][1])];
      if (a != b) sum += edges[e][a ? 0 : 1];
    }
    return sum;
  }
};

TEST(MinCut, IsAsCheapAsTheBestOfAllAssignments) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Rng rng(seed, "min_cut_test", 0);
    const int n = 2 + static_cast<int>(rng.index(8));
    Costs costs;
    MinCut cut(n);
    for (int i = 0; i < n; ++i) {
      costs.nodes.push_back({rng.uniform(), rng.uniform()});
      cut.add_node_cost(i, costs.nodes.back()[0], costs.nodes.back()[1]);
    }
    for (int k = 0; k < 2 * n; ++k) {
      const int a = static_cast<int>(rng.index(static_cast<std::uint32_t>(n))), b = (a + 1) % n;
      costs.ends.push_back({a, b});
      costs.edges.push_back({rng.uniform() * 0.7, rng.uniform() * 0.7});
      cut.add_edge_cost(a, b, costs.edges.back()[0], costs.edges.back()[1]);
    }
    double best = 1e9;
    for (int bits = 0; bits < 1 << n; ++bits) {
      std::vector<char> inside;
      for (int i = 0; i < n; ++i) inside.push_back(static_cast<char>(bits >> i & 1));
      best = std::min(best, costs.of(inside));
    }
    EXPECT_NEAR(costs.of(cut.solve()), best, 1e-9) << seed;
  }
}

}  // namespace
}  // namespace vsgraphs
