#include "core/understanding/structure_builder.h"

#include <gtest/gtest.h>

#include "core/map/test_depth_row.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

TEST(StructureBuilder, ProposesWhatItSoughtAndKeepsNothingOfTheMap) {
  Map map;
  SpaceKeeper space({}, 4);
  StructureBuilder builder{StructureBuilderOptions{}};
  Keyframe keyframe = test::keyframe_seeing({}, Se3{}, test::point_grid(3, 2));
  keyframe.surface = test::depth_row();
  test::add_keyframe(map, keyframe);
  space.gather(map);
  EXPECT_TRUE(builder.due(0));
  EXPECT_TRUE(builder.propose(map.snapshot(), space, SurfaceKeeper(), 0, nullptr).operations.empty())
      << "no way is up yet";
  EXPECT_FALSE(builder.due(1));
  EXPECT_TRUE(builder.due(2));

  map.apply(vsgraphs::SetUp{-Eigen::Vector3d::UnitY()});
  space.catch_up(map, true);
  const MapEdit edit = builder.propose(map.snapshot(), space, SurfaceKeeper(), 2, nullptr);
  ASSERT_EQ(edit.operations.size(), 1U);
  EXPECT_TRUE(std::get<SetStructure>(edit.operations[0]).structure->sought);
  EXPECT_EQ(StructureBuilder{StructureBuilderOptions{}}
                .propose(map.snapshot(), space, SurfaceKeeper(), 2, nullptr)
                .hash(),
            edit.hash());

  EXPECT_FALSE(builder.due(3));
  builder.switch_map();
  EXPECT_TRUE(builder.due(3));
}

}  // namespace
}  // namespace vsgraphs
