#include "core/stages/structure_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_depth_row.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

// Three keyframes side by side with four readings of depth each, patches, and an up direction.
class CarvingTest : public ::testing::Test {
 protected:
  CarvingTest() {
    for (int k = 0; k < 3; ++k) {
      Keyframe keyframe = test::keyframe_seeing({}, test::standing_at(0.5 * k), test::point_grid(3, 2));
      keyframe.surface = test::depth_row();
      keyframes_.push_back(test::add_keyframe(map_, keyframe));
      map_.apply(SetPatches{keyframes_.back(), std::make_shared<const KeyframeSurfaces>()});
    }
    map_.apply(vsgraphs::SetUp{-Eigen::Vector3d::UnitY()});
  }
  std::vector<KeyframeId> carved() {
    builder_.propose(map_.snapshot(), SurfaceKeeper(), 0, true, nullptr);
    std::vector<KeyframeId> ids;
    for (const auto& [id, view] : builder_.free_space().views()) ids.push_back(id);
    return ids;
  }

  Map map_;
  std::vector<KeyframeId> keyframes_;
  StructureBuilder builder_{StructureBuilderOptions{}};
};

TEST_F(CarvingTest, WhatACulledKeyframeCarvedStays) {
  ASSERT_THAT(carved(), testing::ElementsAreArray(keyframes_));
  map_.apply(RemoveKeyframe{keyframes_[1], keyframes_[0]});
  EXPECT_THAT(carved(), testing::ElementsAreArray(keyframes_));
}

TEST_F(CarvingTest, UnlessOthersReplaceIt) {
  ASSERT_THAT(carved(), testing::ElementsAreArray(keyframes_));
  map_.apply(RemoveKeyframe{keyframes_[1], keyframes_[0], true});
  EXPECT_THAT(carved(), testing::ElementsAre(keyframes_[0], keyframes_[2]));
  StructureBuilder anew{StructureBuilderOptions{}};
  anew.propose(map_.snapshot(), SurfaceKeeper(), 0, true, nullptr);
  EXPECT_EQ(builder_.free_space().voxels().memory_bytes(), anew.free_space().voxels().memory_bytes());
}

}  // namespace
}  // namespace vsgraphs
