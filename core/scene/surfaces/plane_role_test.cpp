// What a surface is by geometry alone, each rule in a room of its own. The ground is z = 0, the ceiling 2.5 m above.
#include "core/scene/surfaces/plane_role.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/scene/surfaces/test_surfaces.h"

namespace vsgraphs {
namespace {

using namespace test;

class PlaneRole : public ::testing::Test {
 protected:
  World world = World().room({-4, -3, 0}, {4, 3, 2.5});
  // A walk past the middle of the wall y = 3, and what else is to be looked at.
  std::vector<Se3> poses = {looking({-1, -0.4, 1.4}, {-0.5, 3, 1.3}), looking({0, -0.4, 1.4}, {0, 3, 1.3}),
                            looking({1, -0.4, 1.4}, {0.5, 3, 1.3}), looking({0, 0, 1.4}, {0, 3, 0.8})};
  std::optional<double> ground_m = 0;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

  PlaneEvidence evidence_of(const AnchoredPlane& plane) const {
    const Camera camera;
    PlaneEvidence evidence(frame_of(plane, up));
    for (const Se3& pose : poses) evidence.integrate(plane, view(world, pose), pose, camera.depth_noise);
    return evidence;
  }
  SurfaceRole judge(const AnchoredPlane& plane) const {
    SurfaceFacts facts;
    facts.normal = plane.normal;
    facts.observations = static_cast<int>(poses.size());
    facts.height_m = up.dot(plane.anchor);
    facts.ground_height_m = facts.lowest_level_m = ground_m;
    facts.camera_height_m = 1.4;
    return role_by_geometry(facts, evidence_of(plane), up, {});
  }
  // Upright, towards the cameras, in front of the wall.
  static AnchoredPlane front(double y) { return plane_at({0, y, 1}, -Eigen::Vector3d::UnitY()); }
  static bool wall_or_ground(SurfaceRole role) {
    return role == SurfaceRole::wall || role == SurfaceRole::ground;
  }
};

TEST_F(PlaneRole, WallGroundAndCeilingAreWhatTheyAre) {
  poses.push_back(looking({0, -2, 1.4}, {0, 1, 0}));
  poses.push_back(looking({0, -2, 1.4}, {0, 1, 2.5}));
  EXPECT_EQ(judge(front(3)), SurfaceRole::wall);
  EXPECT_EQ(judge(plane_at({0, 0, 0}, up)), SurfaceRole::ground);
  EXPECT_EQ(judge(plane_at({0, 0, 2.5}, -up)), SurfaceRole::ceiling);
}

TEST_F(PlaneRole, AWallIsAWallBeforeTheGroundIsKnown) {
  ground_m.reset();
  EXPECT_EQ(judge(front(3)), SurfaceRole::wall);
}

TEST_F(PlaneRole, BothTiltAxesAreLookedAt) {
  const auto turned = [&](double angle_rad, const Eigen::Vector3d& axis) {
    return Eigen::Vector3d(Eigen::AngleAxisd(angle_rad, axis) * up);
  };
  for (const Eigen::Vector3d axis : {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()}) {
    for (const double angle_rad : {-0.3, 0.3}) {
      EXPECT_FALSE(stance_allows(SurfaceRole::ground, turned(angle_rad, axis), up, 0.2));
      EXPECT_TRUE(stance_allows(SurfaceRole::ground, turned(angle_rad / 3, axis), up, 0.2));
      const Eigen::Vector3d wall = turned(angle_rad + std::numbers::pi / 2, axis);
      EXPECT_FALSE(stance_allows(SurfaceRole::wall, wall, up, 0.2));
      EXPECT_EQ(judge(plane_at({0, 0, 0}, turned(angle_rad, axis))), SurfaceRole::other) << "a ramp";
    }
  }
}

TEST_F(PlaneRole, AStanceRulesOutWhatANetworkMaySay) {
  EXPECT_FALSE(stance_allows(SurfaceRole::wall, up, up, 0.2));
  EXPECT_FALSE(stance_allows(SurfaceRole::door, up, up, 0.2));
  EXPECT_FALSE(stance_allows(SurfaceRole::ground, -up, up, 0.2)) << "a ceiling";
  EXPECT_FALSE(stance_allows(SurfaceRole::ceiling, up, up, 0.2));
  EXPECT_TRUE(stance_allows(SurfaceRole::window, Eigen::Vector3d::UnitX(), up, 0.2));
}

TEST_F(PlaneRole, AWallSeenOnceIsNotDecided) {
  poses.resize(1);
  EXPECT_EQ(judge(front(3)), SurfaceRole::undecided);
}

TEST_F(PlaneRole, AWallWithADoorOpeningIsAWall) {
  world.sheets.erase(world.sheets.begin(), world.sheets.end());
  World().room({-4, -3, 0}, {4, 6, 2.5}).sheets.swap(world.sheets);  // the next room's far wall shows through
  world.box({-4, 3, 0}, {-0.45, 3.1, 2.5})
      .box({0.45, 3, 0}, {4, 3.1, 2.5})
      .box({-0.45, 3, 2}, {0.45, 3.1, 2.5});
  EXPECT_EQ(judge(front(3)), SurfaceRole::wall);
  const PlaneEvidence evidence = evidence_of(front(3));
  EXPECT_FALSE(evidence.solid_at({0, 3, 1.2})) << "the opening is none of it";
  EXPECT_TRUE(evidence.solid_at({1, 3, 1.2}));
}

TEST_F(PlaneRole, AShortStubThatReachesTheCeilingIsAWall) {
  world.box({-0.3, 1.6, 0}, {0.3, 1.7, 2.5});
  poses.push_back(looking({0, -1.5, 1.4}, {0, 1.6, 1.6}));
  EXPECT_EQ(judge(front(1.6)), SurfaceRole::wall);
}

TEST_F(PlaneRole, ACabinetFrontIsNot) {
  world.box({-0.6, 2.4, 0}, {0.6, 3, 1.2});
  EXPECT_FALSE(wall_or_ground(judge(front(2.4))));
}

TEST_F(PlaneRole, ATallCabinetIsNot) {
  world.box({-0.8, 2.4, 0}, {0.8, 3, 2.0});
  poses.push_back(looking({0, -0.8, 1.4}, {0, 3, 1.7}));
  EXPECT_FALSE(wall_or_ground(judge(front(2.4))));
}

TEST_F(PlaneRole, AShallowCabinetOrACurtainBeforeAWallIsNot) {
  world.box({-0.7, 2.88, 0.1}, {0.7, 3, 1.9});
  EXPECT_FALSE(wall_or_ground(judge(front(2.88))));
}

TEST_F(PlaneRole, TheWallBehindACabinetStaysOne) {
  world.box({-0.6, 2.4, 0}, {0.6, 3, 1.2});
  EXPECT_EQ(judge(front(3)), SurfaceRole::wall);
}

// A curtain whose folds look like a plane turned by 12 degrees, its middle 8 cm before the wall.
TEST_F(PlaneRole, ACurtainTurnedAgainstItsWallHangsOnIt) {
  const double angle_rad = 0.21;
  const Eigen::Vector3d along(std::cos(angle_rad), std::sin(angle_rad), 0);
  const Eigen::Vector3d normal(std::sin(angle_rad), -std::cos(angle_rad), 0);
  const AnchoredPlane wall = front(3);
  const PlaneEvidence wall_seen = evidence_of(wall);
  const auto judged_at = [&](double y) {
    const AnchoredPlane curtain = plane_at({0, y, 1.2}, normal);
    const World empty = world;
    world.sheet(Eigen::Vector3d(0, y, 0.6) - 0.35 * along, 0.7 * along, {0, 0, 1.3});
    const PlaneEvidence seen = evidence_of(curtain);
    world = empty;
    EXPECT_FALSE(larger_is_the_wall({wall, wall_seen}, {curtain, seen}, 0.15)) << "the wall stays one";
    return larger_is_the_wall({curtain, seen}, {wall, wall_seen}, 0.15);
  };
  EXPECT_TRUE(judged_at(2.9));
  EXPECT_FALSE(judged_at(1.9)) << "in the middle of the room it is a screen, or a wall of its own";
}

TEST_F(PlaneRole, AnOpenDoorLeafIsNot) {
  // Turned out of the wall at 0.6 m: half open, and at right angles to it.
  for (const double angle_rad : {0.8, 1.4}) {
    const Eigen::Vector3d along(-std::cos(angle_rad), -std::sin(angle_rad), 0);
    const World empty = world;
    world.sheet({0.9, 2.95, 0.02}, 0.85 * along, {0, 0, 2});
    const Eigen::Vector3d middle = Eigen::Vector3d(0.9, 2.95, 1) + 0.42 * along;
    const AnchoredPlane leaf = plane_at(middle, {-std::sin(angle_rad), std::cos(angle_rad), 0});
    const AnchoredPlane seen =
        leaf.signed_distance(poses[0].translation()) > 0 ? leaf : AnchoredPlane{-leaf.normal, leaf.anchor, 0};
    EXPECT_FALSE(wall_or_ground(judge(seen))) << angle_rad;
    world = empty;
  }
}

TEST_F(PlaneRole, ATableTopIsNot) {
  world.sheet({-0.8, 0.9, 0.74}, {1.6, 0, 0}, {0, 0.8, 0});
  poses.push_back(looking({0, -0.5, 1.5}, {0, 1.3, 0.7}));
  const AnchoredPlane top = plane_at({0, 1.3, 0.74}, up);
  EXPECT_FALSE(wall_or_ground(judge(top)));
  ground_m.reset();
  EXPECT_FALSE(wall_or_ground(judge(top))) << "seen before the ground was";
}

TEST_F(PlaneRole, AStairOrAPodiumIsNotTheGroundButAnotherStoreyIs) {
  ground_m = -2.8;  // the floor below
  poses = {looking({0, -2.5, 1.4}, {0, 0, 0}), looking({1, -2.5, 1.4}, {0, 1, 0}),
           looking({-1, -2.5, 1.4}, {0, 1, 0})};
  EXPECT_EQ(judge(plane_at({0, 0, 0}, up)), SurfaceRole::ground);
  ground_m = 0;
  world.box({-0.7, -1, 0}, {0.7, 0, 0.3});
  EXPECT_FALSE(wall_or_ground(judge(plane_at({0, -0.5, 0.3}, up))));
}

}  // namespace
}  // namespace vsgraphs
