#include "simulate/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "core/base/check.h"
#include "simulate/test_plan.h"

namespace vsgraphs {
namespace {

using ::testing::HasSubstr;
using testing::two_rooms_plan;

// The message of the InputError that building this plan throws; empty if it builds.
std::string complaint(const std::function<void(Plan&)>& change) {
  Plan plan = two_rooms_plan();
  change(plan);
  try {
    build_scene(plan);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Scene, WallsFaceIntoTheirRooms) {
  const Scene scene = build_scene(two_rooms_plan());
  ASSERT_EQ(scene.walls.size(), 8u);
  for (const WallGeometry& wall : scene.walls) {
    const Eigen::Vector2d inside = centroid(scene.plan.rooms[static_cast<std::size_t>(wall.room)].polygon);
    const double d = -wall.normal.dot(wall.p0);
    EXPECT_NEAR(wall.normal.dot(wall.p1) + d, 0, 1e-12);
    EXPECT_NEAR(wall.normal.norm(), 1, 1e-12);
    EXPECT_GT(wall.normal.dot(inside) + d, 1.0);
  }
}

TEST(Scene, FacesOfAWallLieOnItsPlaneAndAreAsLargeAsSaid) {
  const Scene scene = build_scene(two_rooms_plan());
  for (const WallGeometry& wall : scene.walls) {
    double area = 0;
    for (const Face& face : scene.faces) {
      if (face.instance != wall.instance) continue;
      EXPECT_NEAR(face.normal().head<2>().dot(wall.normal), 1, 1e-12);
      EXPECT_NEAR((face.origin.head<2>() - wall.p0).dot(wall.normal), 0, 1e-12);
      for (const Polygon2& contour : face.contours) area += std::abs(signed_area(contour));
    }
    EXPECT_NEAR(area, wall.area(), 1e-9) << wall.room << "/" << wall.side;
  }
  EXPECT_NEAR(scene.walls[1].area(), 4 * 2.6 - 1.0 * 2.0, 1e-12);  // A's wall towards B holds the door
  EXPECT_NEAR(scene.walls[0].area(), 5 * 2.6, 1e-12);
}

TEST(Scene, DoorsJoinBothWalls) {
  const Scene scene = build_scene(two_rooms_plan());
  ASSERT_EQ(scene.doors.size(), 1u);
  const DoorGeometry& door = scene.doors[0];
  EXPECT_NEAR(door.thickness, 0.2, 1e-12);
  EXPECT_TRUE(door.center.isApprox(Eigen::Vector2d(5.1, 2)));
  EXPECT_EQ(scene.instances[door.instance].door, 0);
  EXPECT_EQ(scene.walls[static_cast<std::size_t>(door.walls[0])].openings.size(), 1u);
  EXPECT_EQ(scene.walls[static_cast<std::size_t>(door.walls[1])].openings.size(), 1u);
}

TEST(Scene, EveryKindOfFurnitureStaysInsideItsFootprint) {
  for (const std::string& kind : furniture_kinds()) {
    Plan plan = two_rooms_plan();
    plan.boxes[0].kind = kind;
    plan.boxes[0].size = {0.8, 0.5, 0.9};
    plan.boxes[0].yaw_deg = 90;
    const Scene scene = build_scene(plan);
    int faces = 0;
    const std::uint16_t instance = [&] {
      for (std::size_t i = 0; i < scene.instances.size(); ++i)
        if (scene.instances[i].kind == kind) return static_cast<std::uint16_t>(i);
      return std::uint16_t{0};
    }();
    ASSERT_NE(instance, 0) << kind;
    for (const Face& face : scene.faces) {
      if (face.instance != instance) continue;
      ++faces;
      const bool may_spread =
          kind == "plant" || kind == "bed" || kind == "screen";  // leaves, headboard, foot
      const Eigen::Vector2d offset = face.origin.head<2>() - plan.boxes[0].at;
      EXPECT_LE(std::abs(offset.x()), may_spread ? 0.8 : 0.2501) << kind;
      EXPECT_LE(std::abs(offset.y()), may_spread ? 0.8 : 0.4001) << kind;
    }
    EXPECT_GE(faces, 1) << kind;
  }
}

TEST(Scene, PlansThatCannotBeBuiltSayWhy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaint([](Plan&) {}), "");
  EXPECT_THAT(complaint([](Plan& p) { p.rooms.clear(); }), HasSubstr("rooms: must not be empty"));
  EXPECT_THAT(complaint([](Plan& p) { p.rooms[0].polygon.resize(2); }),
              HasSubstr("rooms[0].polygon: needs at least 3"));
  EXPECT_THAT(complaint([](Plan& p) { std::swap(p.rooms[1].polygon[0], p.rooms[1].polygon[1]); }),
              HasSubstr("rooms[1].polygon: edges cross"));
  EXPECT_THAT(complaint([](Plan& p) { std::reverse(p.rooms[1].polygon.begin(), p.rooms[1].polygon.end()); }),
              HasSubstr("rooms[1].polygon: runs clockwise"));
  EXPECT_THAT(complaint([&](Plan& p) { p.rooms[0].polygon[2].x() = nan; }),
              HasSubstr("rooms[0].polygon[2][0]"));
  EXPECT_THAT(complaint([](Plan& p) { p.rooms[1].id = "A"; }), HasSubstr("rooms[1].id: \"A\" is used twice"));
  EXPECT_THAT(complaint([](Plan& p) { p.rooms[1].floor = "grass"; }),
              HasSubstr("rooms[1].floor: unknown kind \"grass\""));
  EXPECT_THAT(complaint([](Plan& p) { p.doors[0].at = {2, 0}; }), HasSubstr("share no wall"));
  EXPECT_THAT(complaint([](Plan& p) { p.doors[0].at = {5.1, 0.4}; }), HasSubstr("reaches beyond the ends"));
  EXPECT_THAT(complaint([](Plan& p) { p.doors[0].rooms[1] = "Z"; }), HasSubstr("there is no room \"Z\""));
  EXPECT_THAT(complaint([](Plan& p) { p.doors.push_back(p.doors[0]); }),
              HasSubstr("doors[1]: overlaps another"));
  EXPECT_THAT(complaint([](Plan& p) { p.boxes[0].at = {4.9, 3}; }), HasSubstr("boxes[0] (box): its corner"));
  EXPECT_THAT(complaint([](Plan& p) { p.boxes[0].z = 2.3; }), HasSubstr("higher than its room"));
  EXPECT_THAT(complaint([](Plan& p) { p.boxes[0].kind = "throne"; }),
              HasSubstr("boxes[0].kind: unknown kind"));
  EXPECT_THAT(complaint([](Plan& p) { p.posters.push_back({"A", 7}); }), HasSubstr("posters[0].wall"));
  EXPECT_THAT(complaint([](Plan& p) { p.posters.push_back({"A", 1, 2.0}); }),
              HasSubstr("hangs across a door"));
  EXPECT_THAT(complaint([](Plan& p) { p.windows.push_back({"A", 0, 4.9}); }),
              HasSubstr("windows[0]: reaches beyond"));
}

TEST(Scene, MarkersHangOnTheirWallsAndLookIntoTheRoom) {
  Plan plan = two_rooms_plan();
  plan.markers = {{7, "A", 2, 1.0, 1.4, 0.18}, {0, "A", 3, 1.0, 1.5, 0.18}};
  const Scene scene = build_scene(plan);
  ASSERT_EQ(scene.markers.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const MarkerPlan& hung = plan.markers[i];
    const WallGeometry& wall =
        scene.walls[static_cast<std::size_t>(scene.rooms[0].walls[static_cast<std::size_t>(hung.wall)])];
    const Se3& pose = scene.markers[i].world_from_marker;
    const Eigen::Vector3d inwards(wall.normal.x(), wall.normal.y(), 0);
    EXPECT_TRUE(pose.rotation().col(2).isApprox(inwards));
    EXPECT_TRUE(pose.rotation().col(1).isApprox(Eigen::Vector3d::UnitZ()));
    EXPECT_NEAR(pose.rotation().determinant(), 1, 1e-12);
    const Eigen::Vector2d at = wall.p0 + hung.along * wall.along;
    const Eigen::Vector3d middle(at.x(), at.y(), wall.z_floor + hung.z);
    EXPECT_LT((pose.translation() - middle).norm(), 0.01);
    EXPECT_EQ(scene.instances[scene.markers[i].instance].kind, "marker");
  }
}

// Light where the print is white, as read through the texture of the sheet's front.
TEST(Scene, AMarkersFaceShowsItsBits) {
  Plan plan = two_rooms_plan();
  plan.markers = {{7, "A", 2, 1.0, 1.4, 0.18}};
  const Scene scene = build_scene(plan);
  const Eigen::Vector3d outwards = scene.markers[0].world_from_marker.rotation().col(2);
  for (const Face& face : scene.faces) {
    if (face.instance != scene.markers[0].instance || !face.normal().isApprox(outwards)) continue;
    const Texture& texture = scene.materials[static_cast<std::size_t>(face.material)].texture;
    // Number 7 of 4x4_50 in its black frame and the sheet's margin, from the upper left.
    const char* expected[] = {"11111111", "10000001", "10110001", "10010001",
                              "10111101", "10001001", "10000001", "11111111"};
    for (int row = 0; row < 8; ++row)
      for (int column = 0; column < 8; ++column) {
        const float s = (static_cast<float>(column) + 0.5F) / 8, t = 1 - (static_cast<float>(row) + 0.5F) / 8;
        EXPECT_EQ(texture.sample(s, t, 0).r > 128, expected[row][column] == '1') << row << " " << column;
      }
    EXPECT_TRUE(face.s_axis.isApprox(scene.markers[0].world_from_marker.rotation().col(0)));
    EXPECT_TRUE(face.t_axis.isApprox(Eigen::Vector3d::UnitZ()));
    return;
  }
  FAIL() << "no face looks into the room";
}

TEST(Scene, MarkersThatCannotHangSayWhy) {
  EXPECT_THAT(complaint([](Plan& p) { p.markers.push_back({50, "A", 2}); }), HasSubstr("markers[0].id"));
  EXPECT_THAT(complaint([](Plan& p) { p.markers.push_back({-1, "A", 2}); }), HasSubstr("markers[0].id"));
  EXPECT_THAT(complaint([](Plan& p) { p.markers.push_back({1, "A", 2, 1, 1.5, 0}); }),
              HasSubstr("markers[0].size"));
  EXPECT_THAT(complaint([](Plan& p) { p.markers.push_back({1, "Z", 2}); }), HasSubstr("markers[0].room"));
  EXPECT_THAT(complaint([](Plan& p) { p.markers.push_back({1, "A", 1, 2.0}); }),
              HasSubstr("markers[0]: hangs across a door"));
  EXPECT_THAT(complaint([](Plan& p) { p.markers.push_back({1, "A", 2, 0.05}); }),
              HasSubstr("markers[0]: does not fit"));
}

TEST(Scene, PathsThroughThingsNameTheWaypoint) {
  EXPECT_THAT(complaint([](Plan& p) { p.path.waypoints[1].at = {7, 2.9}; }),  // misses the door
              HasSubstr("path.waypoints[0]: the way on from here comes too close to wall 1 of room \"A\""));
  EXPECT_THAT(complaint([](Plan& p) { p.path.waypoints[0].at = {0.1, 2}; }),
              HasSubstr("path.waypoints[0]: stands in or too close to wall 3"));
  EXPECT_THAT(complaint([](Plan& p) {
                p.boxes[0].at = {3, 2};
                p.boxes[0].size.z() = 1.5;
              }),
              HasSubstr("boxes[0] (box)"));
  EXPECT_THAT(complaint([](Plan& p) { p.path.waypoints[1].at = {20, 2}; }),
              HasSubstr("lies in no room and no doorway"));
  EXPECT_THAT(complaint([](Plan& p) { p.path.waypoints[1].z = 2.58; }), HasSubstr("the ceiling"));
  EXPECT_EQ(complaint([](Plan& p) { p.boxes[0].at = {3, 2}; }), "");  // the camera passes over a low box
}

TEST(Scene, StairsLiftTheCamera) {
  Plan plan = two_rooms_plan();
  plan.rooms[1].kind = "stairs";
  plan.rooms[1].height = 5;
  plan.rooms[1].lamps = {{{6, 2}}};
  StairsPlan stairs;
  stairs.room = "B";
  stairs.from = {6.2, 2};
  stairs.to = {8.2, 2};
  stairs.width = 1.5;
  stairs.rise = 1.6;
  stairs.steps = 8;
  stairs.landing = 0.9;
  plan.stairs = {stairs};
  WaypointPlan foot, top;
  foot.at = {6.2, 2}, top.at = {8.4, 2};
  plan.path.waypoints = {plan.path.waypoints[0], foot, top};
  const Scene scene = build_scene(plan);
  EXPECT_NEAR(scene.path.world_from_camera(scene.path.duration_s()).translation().z(), 1.6 + 1.35, 0.02);
  int steps = 0;
  for (const Face& face : scene.faces) steps += face.label == SceneClass::stairs;
  EXPECT_EQ(steps, 8 * 5);
}

TEST(Scene, TheSameEveryTime) {
  const Scene a = build_scene(two_rooms_plan()), b = build_scene(two_rooms_plan());
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t i = 0; i < a.faces.size(); ++i)
    EXPECT_EQ(a.faces[i].lightmap.light, b.faces[i].lightmap.light);
}

}  // namespace
}  // namespace vsgraphs
