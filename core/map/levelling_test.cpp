#include "core/map/levelling.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

// Where the plain formula has no answer: `up` is the first camera's line of sight.
TEST(Levelling, OfAMapThatBeganWithALookStraightDownDoesNotSpin) {
  Map map;
  map.apply(vsgraphs::SetUp{Eigen::Vector3d(0.001, 0, -1).normalized()});
  const Se3 first = levelling(map);
  FoundStructure found;
  found.sought = true;
  found.level_from_world = first;
  map.apply(SetStructure{std::make_shared<const FoundStructure>(found)});
  const Eigen::Vector3d corrected = Eigen::Vector3d(-0.001, 0.001, -1).normalized();
  map.apply(vsgraphs::SetUp{corrected});
  const Se3 second = levelling(map);
  EXPECT_TRUE((second * corrected).isApprox(Eigen::Vector3d::UnitZ(), 1e-9));
  EXPECT_LT(rotation_angle((second * first.inverse()).rotation()), 0.004);
}

}  // namespace
}  // namespace vsgraphs
