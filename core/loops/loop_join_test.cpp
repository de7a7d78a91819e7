// Two maps of one room, each in a world of its own, become one.
#include <gtest/gtest.h>

#include "core/loops/loop_closer.h"
#include "core/loops/test_loop_world.h"
#include "core/vision/place_keeper.h"

namespace vsgraphs {
namespace {

using namespace test;

constexpr double rad = 3.14159265358979 / 180;

// The first turn of a room, and a part of a second turn mapped by itself.
class Join : public ::testing::Test {
 protected:
  static LoopWorldOptions first_turn() {
    LoopWorldOptions o;
    o.keyframes = 30;
    return o;
  }
  static LoopWorldOptions again() {
    LoopWorldOptions o;
    o.keyframes = 6;
    return o;
  }
  // The same with ids behind the first one's, moved into another world.
  Map carried_off(const LoopWorld& world, std::size_t seen_through_walls = 0) const {
    Map map;
    map.apply(OpenMap{older_.map.unused_ids(), 0});
    for (std::size_t k = 0; k < world.ids.size(); ++k) {
      Keyframe keyframe = *world.map.keyframes().find(world.ids[k]);
      if (k < seen_through_walls)
        keyframe.surface =
            std::make_shared<const DepthGrid>(grid_of(world.camera, world.truth[k], square_room(5)));
      keyframe.world_from_camera = elsewhere_ * keyframe.world_from_camera;
      add_keyframe(map, keyframe);
    }
    const std::uint32_t offset = older_.map.unused_ids().keyframe;
    world.map.landmarks().for_each([&](LandmarkId, const Landmark& was) {
      Landmark landmark = was;
      landmark.point_in_world = elsewhere_ * was.point_in_world;
      landmark.appearance.view_direction =
          (elsewhere_.rotation() * was.appearance.view_direction.cast<double>()).cast<float>();
      landmark.observations.clear();
      const LandmarkId id = map.landmarks().next_id();
      map.apply(AddLandmark{id, landmark});
      for (const Observation& o : was.observations)
        map.apply(AddObservation{id, {{o.keyframe.index + offset, 0}, o.feature}});
    });
    return map;
  }
  static KnownMap known(Map& map) {
    PlaceIndex places;
    complete(map, places);
    return {map.snapshot(), std::make_shared<const PlaceIndex>(places)};
  }
  static KeyframeId newest(const Map& map) {
    return map.keyframes().at_index(map.keyframes().index_bound() - 1);
  }

  LoopWorld older_{first_turn()};
  Se3 elsewhere_{so3_exp({0, 70 * rad, 0}), {4, 0.2, -3}};
  LoopCloser closer_{{}, older_.camera, older_.pyramid, 1};
  LoopReport report_;
};

TEST_F(Join, TheOlderMapsWorldStaysAndTheYoungerComesIntoIt) {
  LoopWorld world(again());
  Map younger = carried_off(world);
  younger.apply(MapEdit{});
  const auto join = closer_.join(newest(younger), younger.snapshot(), known(older_.map), report_, nullptr);
  ASSERT_TRUE(join) << to_string(report_.verdict);
  EXPECT_TRUE(join->onto_other);
  EXPECT_LT((join->older_from_younger * elsewhere_).log().norm(), 0.02);
  Map both = older_.map;
  both.apply(join->edit);
  EXPECT_EQ(both.version(), younger.version() + 1) << "versions go on from the map worked on";
  EXPECT_EQ(both.keyframes().size(), 36U);
  for (std::size_t k = 0; k < world.ids.size(); ++k) {
    const KeyframeId id =
        younger.keyframes().at_index(older_.map.unused_ids().keyframe + static_cast<std::uint32_t>(k));
    EXPECT_LT(
        (both.keyframes().find(id)->world_from_camera.translation() - world.truth[k].translation()).norm(),
        0.02);
  }
  for (const KeyframeId id : older_.ids)
    EXPECT_TRUE(both.keyframes().find(id)->world_from_camera.matrix() ==
                older_.map.keyframes().find(id)->world_from_camera.matrix());
  EXPECT_LT(both.landmarks().size(), older_.map.landmarks().size() + younger.landmarks().size() / 2)
      << "what both had mapped became one";
}

TEST_F(Join, FromTheOlderMapTheYoungerIsTakenIn) {
  LoopWorld world(again());
  Map younger = carried_off(world);
  const auto join = closer_.join(older_.ids[2], older_.map.snapshot(), known(younger), report_, nullptr);
  ASSERT_TRUE(join) << to_string(report_.verdict);
  EXPECT_FALSE(join->onto_other);
  EXPECT_LT((join->older_from_younger * elsewhere_).log().norm(), 0.02);
  Map both = older_.map;
  both.apply(join->edit);
  EXPECT_EQ(both.keyframes().size(), 36U);
}

TEST_F(Join, RoomsThatLookAlikeButAreNotOneStayApart) {
  LoopWorldOptions options = again();
  options.half_width_m = 3.0;
  LoopWorld world(options);
  Map younger = carried_off(world);
  // Its walls stand closer in: features alone would join them.
  for (std::uint32_t i = older_.map.unused_ids().keyframe; i < younger.keyframes().index_bound(); ++i) {
    Keyframe keyframe = *younger.keyframes().find(younger.keyframes().at_index(i));
    const Se3 in_room = elsewhere_.inverse() * keyframe.world_from_camera;
    auto narrow = std::make_shared<KeyframeSurfaces>();
    const DepthGrid grid = grid_of(world.camera, in_room, square_room(2.6));
    for (const Wall& wall : square_room(2.6))
      if (auto patch = patch_on(grid, in_room, wall, 0)) narrow->patches.push_back(*patch);
    younger.apply(SetPatches{younger.keyframes().at_index(i), narrow});
  }
  EXPECT_FALSE(closer_.join(newest(younger), younger.snapshot(), known(older_.map), report_, nullptr));
  EXPECT_EQ(report_.verdict, LoopVerdict::surfaces_disagree) << to_string(report_.verdict);
  LoopCloserOptions disarmed;
  disarmed.checks.max_disagreeing_share = 1;
  LoopCloser trusting(disarmed, older_.camera, older_.pyramid, 1);
  EXPECT_TRUE(trusting.join(newest(younger), younger.snapshot(), known(older_.map), report_, nullptr));
}

TEST_F(Join, WhatSurroundsThemTellsRoomsApartThatAreAlikeWhereTheCameraStands) {
  LoopWorldOptions options = again();
  options.keyframes = 14;
  LoopWorld world(options);
  // The camera came from where it saw farther than the other room is wide.
  Map younger = carried_off(world, 4);
  EXPECT_FALSE(closer_.join(newest(younger), younger.snapshot(), known(older_.map), report_, nullptr));
  EXPECT_EQ(report_.verdict, LoopVerdict::neighbours_disagree) << to_string(report_.verdict);
  EXPECT_GT(report_.neighbours.through, 0);
  LoopCloserOptions disarmed;
  disarmed.checks.max_contradicted_share = 1;
  LoopCloser trusting(disarmed, older_.camera, older_.pyramid, 1);
  EXPECT_TRUE(trusting.join(newest(younger), younger.snapshot(), known(older_.map), report_, nullptr));
}

TEST_F(Join, UpOfTheTwoMustAgree) {
  LoopWorld world(again());
  Map younger = carried_off(world);
  older_.map.apply(vsgraphs::SetUp{{0, -1, 0}});
  younger.apply(vsgraphs::SetUp{so3_exp({0.2, 0, 0}) * Eigen::Vector3d(0, -1, 0)});
  EXPECT_FALSE(closer_.join(newest(younger), younger.snapshot(), known(older_.map), report_, nullptr));
  EXPECT_EQ(report_.verdict, LoopVerdict::tilted);
  younger.apply(vsgraphs::SetUp{{0, -1, 0}});
  EXPECT_TRUE(closer_.join(newest(younger), younger.snapshot(), known(older_.map), report_, nullptr));
}

TEST_F(Join, AStrangePlaceIsNone) {
  Map strange;
  strange.apply(OpenMap{older_.map.unused_ids(), 0});
  add_keyframe(strange, keyframe_seeing(older_.camera, standing_at(0), point_grid(8, 6), 100000));
  EXPECT_FALSE(closer_.join(newest(strange), strange.snapshot(), known(older_.map), report_, nullptr));
  EXPECT_EQ(report_.verdict, LoopVerdict::none_similar);
}

}  // namespace
}  // namespace vsgraphs
