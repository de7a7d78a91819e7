#include "core/scene/rooms/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

float brute_force(const GridFrame& frame, const GridValues<char>& passable, int cell) {
  if (!passable[static_cast<std::size_t>(cell)]) return 0;
  double best = 1e9;
  for (int y = -1; y <= frame.height; ++y)
    for (int x = -1; x <= frame.width; ++x) {
      const Eigen::Vector2i other(x, y);
      if (frame.inside(other) && passable[static_cast<std::size_t>(frame.index(other))]) continue;
      best = std::min(best, (other - frame.cell(cell)).cast<double>().norm());
    }
  return static_cast<float>(best * frame.cell_m);
}

TEST(Clearance, AgreesWithBruteForce) {
  Rng rng(1, "clearance_test", 0);
  for (const double density : {0.02, 0.3, 0.0, 1.0}) {
    const GridFrame frame{{-3, 5}, 0.1, 23, 17};
    GridValues<char> passable;
    for (int i = 0; i < frame.size(); ++i) passable.push_back(rng.uniform() >= density);
    const GridValues<float> clearance = clearance_field(frame, passable);
    for (int i = 0; i < frame.size(); ++i)
      EXPECT_NEAR(clearance[static_cast<std::size_t>(i)], brute_force(frame, passable, i), 1e-5);
  }
  EXPECT_TRUE(clearance_field({}, {}).empty());
}

}  // namespace
}  // namespace vsgraphs
