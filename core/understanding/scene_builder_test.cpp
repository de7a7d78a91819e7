// Rooms seen keyframe by keyframe, as the scene builder understands them.
#include "core/understanding/scene_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_map.h"
#include "core/scene/surfaces/test_surfaces.h"

namespace vsgraphs {
namespace {

using namespace test;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class SceneBuilderTest : public ::testing::Test {
 protected:
  // A keyframe in the map that sees the world from `pose`, and what the builder makes of it.
  KeyframeId see(const Se3& pose, const Points& points = {}) {
    Keyframe keyframe = keyframe_seeing(camera, pose, points);
    keyframe.surface = std::make_shared<const DepthGrid>(view(world, pose, camera));
    const KeyframeId id = map.keyframes().next_id();
    apply({map.version(), {AddKeyframe{id, keyframe}}});
    if (propose_at_once) propose(id);
    return id;
  }
  void propose(KeyframeId id, const LabelGrid* labels = nullptr) {
    apply(builder.associate(id, map.snapshot(), surfaces, labels, nullptr));
    apply(builder.interpret(id, map.snapshot(), surfaces, nullptr));
  }
  void apply(const MapEdit& edit) {
    hashes.push_back(edit.hash());
    const Snapshot before = map.snapshot();
    map.apply(edit);
    surfaces.follow(*before, edit, map, nullptr);
  }
  LabelGrid all_labelled(SurfaceRole role, float confidence) const {
    LabelGrid labels;
    labels.columns = camera.width / 8;
    labels.rows = camera.height / 8;
    labels.samples.assign(static_cast<std::size_t>(labels.columns * labels.rows), {role, confidence, 0});
    return labels;
  }
  // The planes through `point` that look along `normal`.
  std::vector<PlaneId> planes_at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    std::vector<PlaneId> ids;
    map.planes().for_each([&](PlaneId id, const MappedPlane& p) {
      if (p.plane.normal.dot(normal) > 0.99 && std::abs(p.plane.signed_distance(point)) < 0.03)
        ids.push_back(id);
    });
    return ids;
  }
  const MappedPlane& plane(PlaneId id) const { return *map.planes().find(id); }
  SurfaceRole role_at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    const auto ids = planes_at(point, normal);
    EXPECT_THAT(ids, SizeIs(1));
    return ids.empty() ? SurfaceRole::undecided : plane(ids[0]).role;
  }
  // Three looks into the corner with the wall y = 3 and the floor z = 0.
  void walk() {
    for (const double x : {-0.4, 0.0, 0.4}) see(looking({x, 0, 1.4}, {x, 3, 0.7}));
  }

  Camera camera;
  World world = World().room({-4, -3, 0}, {4, 3, 2.5});
  Map map;
  SceneBuilder builder{SceneBuilderOptions{}, camera};
  SurfaceKeeper surfaces{camera.depth_noise};
  std::vector<std::uint64_t> hashes;
  bool propose_at_once = true;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), south = -Eigen::Vector3d::UnitY();
};

TEST_F(SceneBuilderTest, OneWallSeenThriceIsOnePlaneAndGroundAnother) {
  walk();
  EXPECT_EQ(role_at({0, 3, 1}, south), SurfaceRole::wall);
  EXPECT_EQ(role_at({0, 0, 0}, up), SurfaceRole::ground);
  EXPECT_THAT(plane(planes_at({0, 3, 1}, south)[0]).observations, SizeIs(3));
  ASSERT_TRUE(map.up_in_world());
  EXPECT_LT((*map.up_in_world() - up).norm(), 1e-3);
}

TEST_F(SceneBuilderTest, ClassesWaitForUpAndAreThenGivenInRetrospect) {
  // One wall alone: up is not known.
  world = World().sheet({-4, 3, -3}, {8, 0, 0}, {0, 0, 6});
  see(looking({-0.3, 0, 1.4}, {-0.3, 3, 1.4}));
  see(looking({0.3, 0, 1.4}, {0.3, 3, 1.4}));
  EXPECT_FALSE(map.up_in_world());
  EXPECT_EQ(role_at({0, 3, 1}, south), SurfaceRole::undecided);
  // Then ground elsewhere; the wall is not in the image.
  world = World().sheet({-4, -9, 0}, {8, 0, 0}, {0, 8, 0});
  see(looking({0, -1, 1.4}, {0, -4, 0}));
  ASSERT_TRUE(map.up_in_world());
  EXPECT_EQ(role_at({0, 3, 1}, south), SurfaceRole::wall);
}

TEST_F(SceneBuilderTest, ATiltedFirstCameraAndRollDoNotMatter) {
  for (const double roll_rad : {-0.5, 0.5}) see(looking({0, 0, 1.4}, {0.5, 3, 0.7}, roll_rad));
  see(looking({0.3, 0, 1.4}, {0.5, 3, 0.7}, 0.5));
  ASSERT_TRUE(map.up_in_world());
  EXPECT_LT((*map.up_in_world() - up).norm(), 2e-3);
  EXPECT_EQ(role_at({0, 3, 1}, south), SurfaceRole::wall);
}

TEST_F(SceneBuilderTest, GroundInTwoHeightsIsTwoGrounds) {
  walk();
  world = World().room({6, -3, 2.8}, {14, 3, 5.3});  // the storey above, beside
  for (const double x : {9.6, 10.0, 10.4}) see(looking({x, 0, 4.2}, {x, 3, 3.5}));
  EXPECT_EQ(role_at({0, 0, 0}, up), SurfaceRole::ground);
  EXPECT_EQ(role_at({10, 0, 2.8}, up), SurfaceRole::ground);
}

TEST_F(SceneBuilderTest, VotesChangeAClassAndItCanBeLostAgain) {
  walk();
  const PlaneId wall = planes_at({0, 3, 1}, south)[0];
  ASSERT_EQ(plane(wall).role, SurfaceRole::wall);
  std::vector<KeyframeId> seen;
  for (const PlaneObservation& o : plane(wall).observations) seen.push_back(o.keyframe);
  const LabelGrid door = all_labelled(SurfaceRole::door, 0.9F),
                  none = all_labelled(SurfaceRole::undecided, 0);
  for (const KeyframeId id : seen) propose(id, &door);
  EXPECT_EQ(role_at({0, 3, 1}, south), SurfaceRole::door) << "2.7 votes against geometry's 1.5";
  EXPECT_EQ(planes_at({0, 3, 1}, south)[0], wall) << "it is the plane it was";
  for (const KeyframeId id : seen) propose(id, &none);
  EXPECT_EQ(role_at({0, 3, 1}, south), SurfaceRole::wall);
}

TEST_F(SceneBuilderTest, AWallWhoseObserversAreAllRetiredStaysOneWhereSurfacesAreGatheredAnew) {
  walk();
  const PlaneId wall = planes_at({0, 3, 1}, south)[0];
  std::vector<KeyframeId> seen;
  for (const PlaneObservation& o : plane(wall).observations) seen.push_back(o.keyframe);
  const KeyframeId stays = see(looking({0, 0, 1.4}, {0, -3, 0.7}));
  for (const KeyframeId id : seen) apply({map.version(), {RemoveKeyframe{id, stays}}});
  surfaces.gather(map);
  see(looking({0.3, 0, 1.4}, {0.3, -3, 0.7}));
  EXPECT_EQ(plane(wall).role, SurfaceRole::wall) << "nobody alive sees it";
  for (const double x : {-0.3, 0.3}) see(looking({x, 0, 1.4}, {x, 3, 0.7}));
  EXPECT_EQ(role_at({0, 3, 1}, south), SurfaceRole::wall);
}

TEST_F(SceneBuilderTest, ManySmallPostersDoNotOutvoteTheirWall) {
  walk();
  LabelGrid labels = all_labelled(SurfaceRole::wall, 0.9F);
  // A quarter of the image, in columns: each a patch of its own.
  for (int row = 0; row < labels.rows; ++row) {
    for (int column = 4; column < labels.columns; column += 16) {
      for (int c = column; c < std::min(column + 4, labels.columns); ++c)
        labels.samples[static_cast<std::size_t>(row * labels.columns + c)].role = SurfaceRole::other;
    }
  }
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { propose(id, &labels); });
  const auto wall = planes_at({0, 3, 1}, south);
  ASSERT_THAT(wall, SizeIs(1));
  const auto votes = [&](SurfaceRole role) { return plane(wall[0]).votes[static_cast<std::size_t>(role)]; };
  EXPECT_GT(plane(wall[0]).observations.size(), 9U) << "more posters than walls";
  EXPECT_GT(votes(SurfaceRole::wall), 2 * votes(SurfaceRole::other));
  EXPECT_LT(votes(SurfaceRole::wall) + votes(SurfaceRole::other), 3 * 0.9 + 1.5 + 1e-3)
      << "a keyframe has one vote";
  EXPECT_EQ(plane(wall[0]).role, SurfaceRole::wall);
}

// Upper half of the image a class, lower half another; their roles stay undecided.
LabelGrid named_halves(LabelGrid labels, const std::string& above, const std::string& below) {
  for (std::size_t i = 0; i < labels.samples.size(); ++i)
    labels.samples[i].named = class_id(i < labels.samples.size() / 2 ? above : below);
  labels.class_names = {{class_id(above), above}, {class_id(below), below}};
  return labels;
}

TEST_F(SceneBuilderTest, AWallHasTheVotesOfWhatItWasCalledAndItsKeyframesKeepTheRest) {
  walk();
  const PlaneId wall = planes_at({0, 3, 1}, south)[0];
  ASSERT_THAT(plane(wall).class_votes, IsEmpty());
  const LabelGrid labels = named_halves(all_labelled(SurfaceRole::undecided, 0.8F), "picture", "carpet");
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { propose(id, &labels); });
  const ClassVotes& votes = plane(wall).class_votes;
  EXPECT_EQ(votes, surfaces.find(wall)->class_votes());
  const auto votes_for = [&votes](const std::string& name) {
    float weight = 0;
    for (const ClassVote& vote : votes) weight += vote.id == class_id(name) ? vote.weight : 0;
    return weight;
  };
  EXPECT_GT(votes_for("picture"), 1.5F * votes_for("carpet")) << "the floor has most of the lower half";
  EXPECT_NEAR(votes_for("picture") + votes_for("carpet"), 3 * 0.8F, 1e-3F) << "a keyframe has one vote";
  EXPECT_EQ(plane(wall).role, SurfaceRole::wall) << "of which classes decide nothing";
  EXPECT_THAT(map.class_names(), SizeIs(2));
  map.keyframes().for_each([&](KeyframeId, const Keyframe& keyframe) {
    ASSERT_NE(keyframe.classes, nullptr);
    EXPECT_EQ(keyframe.classes->which.size(), keyframe.surface->samples.size());
  });
}

TEST_F(SceneBuilderTest, AKeyframeRelabelledTakesItsClassesBack) {
  walk();
  const PlaneId wall = planes_at({0, 3, 1}, south)[0];
  const KeyframeId id{1, 0};
  const LabelGrid named = named_halves(all_labelled(SurfaceRole::undecided, 0.8F), "picture", "carpet");
  const LabelGrid renamed = named_halves(all_labelled(SurfaceRole::undecided, 0.8F), "mirror", "carpet");
  propose(id, &named);
  ASSERT_FALSE(plane(wall).class_votes.empty());
  propose(id, &renamed);
  for (const ClassVote& vote : plane(wall).class_votes) EXPECT_NE(vote.id, class_id("picture"));
  EXPECT_EQ(plane(wall).class_votes, surfaces.find(wall)->class_votes());
  const LabelGrid unnamed = all_labelled(SurfaceRole::undecided, 0.8F);
  propose(id, &unnamed);
  EXPECT_THAT(plane(wall).class_votes, IsEmpty());
  EXPECT_THAT(surfaces.find(wall)->class_votes(), IsEmpty());
  EXPECT_EQ(map.keyframes().find(id)->classes, nullptr);
  EXPECT_THAT(map.class_names(), SizeIs(3)) << "names stay";
}

TEST_F(SceneBuilderTest, ANetworkDoesNotMakeACurtainAWall) {
  world.sheet({-0.7, 2.88, 0.4}, {1.6, 0, 0}, {0, 0, 1.8});
  walk();
  const LabelGrid wall = all_labelled(SurfaceRole::wall, 0.9F);
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { propose(id, &wall); });
  EXPECT_EQ(role_at({0, 2.88, 1}, south), SurfaceRole::other);
  EXPECT_EQ(role_at({0, 3, 1}, south), SurfaceRole::wall);
}

TEST_F(SceneBuilderTest, ANetworkDoesNotMakeAFloorAWall) {
  walk();
  const LabelGrid wall = all_labelled(SurfaceRole::wall, 1.0F);
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { propose(id, &wall); });
  EXPECT_EQ(role_at({0, 0, 0}, up), SurfaceRole::ground);
}

TEST_F(SceneBuilderTest, LateLabelsReplaceThePatchesOfTheirKeyframe) {
  walk();
  const KeyframeId id{1, 0};
  EXPECT_FALSE(map.keyframes().find(id)->patches->labelled);
  const std::size_t planes = map.planes().size();
  const LabelGrid labels = all_labelled(SurfaceRole::wall, 0.8F);
  propose(id, &labels);
  EXPECT_TRUE(map.keyframes().find(id)->patches->labelled);
  EXPECT_EQ(map.planes().size(), planes);
  const MappedPlane& wall = plane(planes_at({0, 3, 1}, south)[0]);
  EXPECT_THAT(wall.observations, SizeIs(3)) << "not counted twice";
}

TEST_F(SceneBuilderTest, TwoFacesOfAWallAreLinkedWithItsThickness) {
  world.box({-4, 1.0, 0}, {0.8, 1.15, 2.5});  // with a way round it
  for (const double x : {-1.4, -1.0, -0.6}) see(looking({x, -2, 1.4}, {x, 1, 0.9}));
  for (const double x : {-1.4, -1.0, -0.6}) see(looking({x, 2.9, 1.4}, {x, 1, 0.6}));
  const auto here = planes_at({-1, 1, 1}, south), there = planes_at({-1, 1.15, 1}, -south);
  ASSERT_THAT(here, SizeIs(1));
  ASSERT_THAT(there, SizeIs(1));
  ASSERT_EQ(plane(here[0]).role, SurfaceRole::wall);
  ASSERT_EQ(plane(there[0]).role, SurfaceRole::wall);
  EXPECT_EQ(plane(here[0]).other_face, there[0]);
  EXPECT_EQ(plane(there[0]).other_face, here[0]);
  EXPECT_NEAR(plane(here[0]).thickness_m, 0.15, 0.01);
}

TEST_F(SceneBuilderTest, PointsBehindAWallGoThoseThroughItsOpeningStay) {
  world = World().room({-4, -3, 0}, {4, 6, 2.5});
  world.box({-4, 3, 0}, {-0.5, 3.1, 2.5}).box({0.5, 3, 0}, {4, 3.1, 2.5}).box({-0.5, 3, 2}, {0.5, 3.1, 2.5});
  propose_at_once = false;
  const Points points = {{1.2, 5, 1.2}, {0, 5, 1.2}, {1.2, 2.99, 1.2}};
  std::vector<KeyframeId> ids;
  for (const double x : {-0.2, 0.0, 0.2}) ids.push_back(see(looking({x, 0, 1.4}, {x, 3, 1.0}), points));
  const std::vector<LandmarkId> landmarks = add_landmarks(map, points, ids);
  for (const KeyframeId id : ids) propose(id);
  ASSERT_EQ(role_at({1, 3, 1}, south), SurfaceRole::wall);
  EXPECT_FALSE(map.landmarks().contains(landmarks[0])) << "2 m behind the wall";
  EXPECT_TRUE(map.landmarks().contains(landmarks[1])) << "through the opening";
  EXPECT_TRUE(map.landmarks().contains(landmarks[2])) << "on the wall";
}

TEST_F(SceneBuilderTest, WhatIsKnownOfAWallGoesAlongWithALoop) {
  const auto with_door = [](double x) {
    return World()
        .room({-4 + x, -3, 0}, {4 + x, 6, 2.5})
        .box({-4 + x, 3, 0}, {-0.5 + x, 3.1, 2.5})
        .box({0.5 + x, 3, 0}, {4 + x, 3.1, 2.5})
        .box({-0.5 + x, 3, 2}, {0.5 + x, 3.1, 2.5});
  };
  world = with_door(0);
  for (const double x : {-0.2, 0.0, 0.2}) see(looking({x, 0, 1.4}, {x, 3, 1.0}));
  ASSERT_EQ(role_at({1, 3, 1}, south), SurfaceRole::wall);
  // A loop takes it all 1 m along the wall.
  const Se3 change = standing_at(1);
  MapEdit loop{map.version(), {}};
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    loop.operations.push_back(MoveKeyframe{id, change * keyframe.world_from_camera});
  });
  map.planes().for_each([&](PlaneId id, const MappedPlane& p) {
    loop.operations.push_back(MovePlane{id, p.plane.transformed(change)});
  });
  apply(loop);
  world = with_door(1);
  propose_at_once = false;
  const Points through_the_door = {{1, 5, 1.2}};
  const KeyframeId next = see(looking({1, 0, 1.4}, {1, 3, 1.0}), through_the_door);
  const LandmarkId landmark = add_landmarks(map, through_the_door, {next})[0];
  propose(next);
  EXPECT_TRUE(map.landmarks().contains(landmark)) << "held against the wall where it stood before";
}

TEST_F(SceneBuilderTest, EqualKeyframesMakeEqualEdits) {
  walk();
  const std::vector<std::uint64_t> first = hashes;
  map = Map{};
  surfaces.gather(map);
  hashes.clear();
  walk();
  EXPECT_EQ(hashes, first);
}

TEST_F(SceneBuilderTest, WithoutDepthNothingIsProposed) {
  const KeyframeId id = add_keyframe(map, keyframe_seeing(camera, {}, {}));
  EXPECT_THAT(builder.associate(id, map.snapshot(), surfaces, nullptr, nullptr).operations, IsEmpty());
  EXPECT_THAT(builder.associate(KeyframeId{9, 0}, map.snapshot(), surfaces, nullptr, nullptr).operations,
              IsEmpty());
}

}  // namespace
}  // namespace vsgraphs
