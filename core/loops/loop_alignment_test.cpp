#include "core/loops/loop_alignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/loops/test_loop_world.h"

namespace vsgraphs {
namespace {

class LoopAlignmentTest : public ::testing::Test {
 protected:
  static test::LoopWorldOptions options() {
    test::LoopWorldOptions o;
    o.keyframes = 33;
    o.grids = o.patches = false;
    o.drift_per_step << 0.003, 0.002, 0.003, 0, 0.001, 0;
    return o;
  }
  KeyframeId at(int k) const { return world_.ids[static_cast<std::size_t>(k)]; }
  std::optional<LoopAlignment> align(int k, int place) const {
    return aligner_.align(world_.map, at(k), place_around(world_.map, at(place), 10), Rng(1, "test", 0));
  }

  test::LoopWorld world_{options()};
  LoopAligner aligner_{{}, world_.camera, world_.pyramid};
};

TEST_F(LoopAlignmentTest, FindsTheKeyframeWhereThePlaceHasIt) {
  const auto loop = align(31, 2);
  ASSERT_TRUE(loop.has_value());
  // Keyframe 1 stands in the same spot and drifted as little as the place.
  const Se3 expected = world_.map.keyframes().find(at(1))->world_from_camera;
  EXPECT_LT((expected.inverse() * loop->world_from_camera).log().norm(), 0.02);
  EXPECT_GT(loop->sights.size(), 100U);
  const Keyframe& keyframe = *world_.map.keyframes().find(at(31));
  for (const auto& [feature, landmark] : loop->sights)
    EXPECT_EQ(world_.map.landmarks().find(landmark)->appearance.descriptor,
              keyframe.features->descriptor(feature));
}

TEST_F(LoopAlignmentTest, FindsNothingWhereThePlaceIsAnother) { EXPECT_FALSE(align(31, 15).has_value()); }

TEST_F(LoopAlignmentTest, NeighboursThatSeeThePlaceSupportIt) {
  const auto loop = align(31, 2);
  const MappedPlace there = place_around(world_.map, at(2), 10);
  EXPECT_THAT(aligner_.supporters(world_.map, *loop, there, {at(30), at(31), at(32), at(16)}),
              ::testing::ElementsAre(at(30), at(32)));
}

TEST_F(LoopAlignmentTest, NeighboursThatSeeItElsewhereDoNot) {
  auto loop = align(31, 2);
  const MappedPlace there = place_around(world_.map, at(2), 10);
  // As if keyframe 31 had been aligned 0.3 m off: its neighbours, moved along, find the place 0.3 m beside that.
  loop->world_from_camera = test::standing_at(0.3) * loop->world_from_camera;
  EXPECT_TRUE(aligner_.supporters(world_.map, *loop, there, {at(30), at(32)}).empty());
}

TEST_F(LoopAlignmentTest, APlaceIsItsCentreAndThoseThatShareMost) {
  const MappedPlace place = place_around(world_.map, at(10), 3);
  EXPECT_EQ(place.centre, at(10));
  EXPECT_THAT(place.keyframes, ::testing::UnorderedElementsAre(at(10), at(9), at(11)));
  const auto landmarks = landmarks_of(world_.map, place.keyframes);
  std::vector<LandmarkId> unique = landmarks;
  std::sort(unique.begin(), unique.end());
  EXPECT_EQ(std::unique(unique.begin(), unique.end()), unique.end());
}

}  // namespace
}  // namespace vsgraphs
