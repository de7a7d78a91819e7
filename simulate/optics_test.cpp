// Mirrors, glass, and things that move, against what can be worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulate/renderer.h"
#include "simulate/test_plan.h"

namespace vsgraphs {
namespace {

using testing::small_camera;

// One room of 5 x 4 m; the camera stands still at (2.5, 2) and looks at the wall in the east, x = 5.
Plan still_plan() {
  Plan plan = testing::two_rooms_plan();
  plan.rooms.resize(1);
  plan.doors.clear();
  plan.boxes.clear();
  plan.rooms[0].lamps.emplace();
  WaypointPlan stand;
  stand.at = {2.5, 2};
  stand.yaw_deg = 0;
  stand.pause_s = 20;
  plan.path.waypoints = {stand};
  return plan;
}

SceneClass label_at(const RenderedFrame& frame, int u, int v) {
  return static_cast<SceneClass>(frame.label.at(u, v));
}

constexpr int middle_u = 79, middle_v = 59;

TEST(Optics, AMirrorShowsWhatLiesBehindTheCamera) {
  Plan plan = still_plan();
  plan.posters.push_back({"A", 1, 2.0, 1.35, 1.6, 1.2, "mirror", 0});
  BoxPlan box;  // behind the camera, to its right: y = 1.5
  box.room = "A", box.at = {0.5, 1.5}, box.size = {0.4, 0.4, 1.6};
  plan.boxes = {box};
  const Scene scene = build_scene(plan);
  const Camera camera = small_camera();
  const RenderedFrame frame = Renderer(scene, camera, NoiseOptions::none()).render(30);
  // The mirror's face lies 1 cm before the wall, at x = 4.99. The box's front is at x = 0.7: its image at 4.99 + 4.29 = 9.28.
  const Eigen::Vector3d image(9.28, 1.5, 1.35);
  const Eigen::Vector3d c = frame.world_from_camera.inverse() * image;
  const int u = static_cast<int>(std::lround(camera.fx * c.x() / c.z() + camera.cx)),
            v = static_cast<int>(std::lround(camera.fy * c.y() / c.z() + camera.cy));
  EXPECT_NEAR(frame.depth.at(u, v) / camera.depth_scale, c.z(), 0.02);
  EXPECT_EQ(label_at(frame, u, v), SceneClass::mirror);  // the truth says what hangs there
  // Beside it the mirror shows the wall in the west: x = 0, image at 9.98.
  EXPECT_NEAR(frame.depth.at(u - 15, v) / camera.depth_scale, 9.98 - 2.5, 0.02);
  // Outside the mirror there is the wall it hangs on.
  EXPECT_EQ(label_at(frame, middle_u, 12), SceneClass::wall);
  EXPECT_NEAR(frame.depth.at(middle_u, 12) / camera.depth_scale, 2.5, 0.02);
  // The colours are the box's too: another box, another image, there and nowhere else.
  plan.boxes[0].colour = Rgb{250, 20, 20};
  const Scene other = build_scene(plan);
  const RenderedFrame red = Renderer(other, camera, NoiseOptions::none()).render(30);
  EXPECT_GT(red.rgb.at(u, v).r, frame.rgb.at(u, v).r + 20);
  EXPECT_EQ(red.rgb.at(u - 15, v), frame.rgb.at(u - 15, v));
}

TEST(Optics, AMirrorTurnsThingsRound) {
  Plan plan = still_plan();
  plan.posters.push_back({"A", 1, 2.0, 1.35, 2.4, 1.2, "mirror", 0});
  BoxPlan left;  // of the camera, which looks along +x: y > 2
  left.room = "A", left.at = {1.0, 2.8}, left.size = {0.4, 0.4, 1.6};
  plan.boxes = {left};
  const Scene scene = build_scene(plan);
  const RenderedFrame frame = Renderer(scene, small_camera(), NoiseOptions::none()).render(30);
  // Somebody on my left is on the left in the mirror.
  int on_left = 0, on_right = 0;
  for (int u = 0; u < 160; ++u) {
    const double z = frame.depth.at(u, middle_v) / 5000.0;
    if (z > 6.0 && z < 6.6) ++(u < 79 ? on_left : on_right);
  }
  EXPECT_GT(on_left, on_right + 6);  // on the right a strip of the side wall is as far off
}

TEST(Optics, ExactDepthPassesThroughGlassAndTheTruthNamesIt) {
  Plan plan = still_plan();
  plan.partitions.push_back({"A", {3.5, 0.02}, {3.5, 3.98}, 2.2, 0.06, "glass", 4.0});
  const Scene scene = build_scene(plan), open = build_scene(still_plan());
  const RenderedFrame frame = Renderer(scene, small_camera(), NoiseOptions::none()).render(30),
                      without = Renderer(open, small_camera(), NoiseOptions::none()).render(30);
  EXPECT_NEAR(frame.depth.at(middle_u, middle_v) / 5000.0, 2.5, 0.01);  // the wall behind
  EXPECT_EQ(label_at(frame, middle_u, middle_v), SceneClass::glass);
  const int seen = frame.rgb.at(middle_u, middle_v).g, clear = without.rgb.at(middle_u, middle_v).g;
  EXPECT_NEAR(seen, 0.88 * clear + 7, 3);  // a little darker, with a sheen
  NoiseOptions kinect = NoiseOptions::of("kinect1");
  const RenderedFrame sensed = Renderer(scene, small_camera(), kinect).render(30);
  int missing = 0;  // squarely before the pane
  for (int v = 54; v < 64; ++v)
    for (int u = 74; u < 84; ++u) missing += sensed.depth.at(u, v) == 0;
  EXPECT_GT(missing, 40);
}

TEST(Optics, ThroughAWindowThereIsABalconyOrAStreet) {
  for (const std::string& view : {std::string("parapet"), std::string("street")}) {
    Plan plan = still_plan();
    WindowPlan window;
    window.room = "A", window.wall = 1, window.along = 2, window.sill = 0.5, window.height = 1.6,
    window.view = view;
    plan.windows = {window};
    plan.path.pitch_deg = -12;
    const Scene scene = build_scene(plan);
    const RenderedFrame frame = Renderer(scene, small_camera(), NoiseOptions::none()).render(30);
    EXPECT_EQ(label_at(frame, middle_u + 6, middle_v), SceneClass::window);
    const double z = frame.depth.at(middle_u + 6, middle_v) / 5000.0;
    if (view == "parapet") {
      EXPECT_GT(z, 4.0);
      EXPECT_LT(z, 4.8);  // the breast wall, 1.8 m beyond the pane's wall
    } else {
      EXPECT_TRUE(z == 0 || z > 7) << z;
    }
  }
}

TEST(Motion, DoorsSwingAtTheirTime) {
  Plan plan = testing::two_rooms_plan();
  DoorLeafPlan leaf;
  leaf.room = "B", leaf.angle_deg = 90, leaf.turns = {{4.0, 0.0}};
  plan.doors[0].leaf = leaf;
  plan.path.waypoints.resize(1);
  plan.path.waypoints[0].pause_s = 10;
  const Scene scene = build_scene(plan);
  Renderer renderer(scene, small_camera(), NoiseOptions::none());
  const RenderedFrame before = renderer.render(90), after = renderer.render(240);
  const auto in_doorway = [](const RenderedFrame& f) { return f.depth.at(middle_u, middle_v) / 5000.0; };
  EXPECT_NEAR(in_doorway(before), 8.2, 0.05);  // the far wall of B
  EXPECT_NEAR(in_doorway(after), 4.2, 0.1);    // the leaf, beyond the wall between
  EXPECT_EQ(label_at(after, middle_u, middle_v), SceneClass::door);
}

TEST(Motion, LeavesSetBackStandBehindTheWallsFace) {
  Plan plan = testing::two_rooms_plan();
  DoorLeafPlan leaf;
  leaf.room = "A", leaf.angle_deg = 0, leaf.set_back = 0.08;
  plan.doors[0].leaf = leaf;
  plan.path.waypoints.resize(1);
  plan.path.waypoints[0].pause_s = 4;
  const RenderedFrame frame = Renderer(build_scene(plan), small_camera(), NoiseOptions::none()).render(20);
  EXPECT_NEAR(frame.depth.at(middle_u, middle_v) / 5000.0, 4.08, 0.005);
}

TEST(Motion, PeopleWalkToAndFro) {
  const Walk walk({{0, 0}, {4, 0}}, 1.0, 2.0, 0, 0.5);
  EXPECT_NEAR((walk.world_from_body(1).translation() - Eigen::Vector3d(0, 0, 0.5)).norm(), 0, 1e-9);
  EXPECT_NEAR(walk.world_from_body(4).translation().x(), 2, 1e-9);
  const double turn = std::numbers::pi / 2.0;  // seconds: half a turn at 2 rad/s
  EXPECT_NEAR(walk.world_from_body(6 + turn + 1).translation().x(), 3, 1e-9);
  EXPECT_NEAR(walk.world_from_body(6 + turn + 1).rotation()(0, 0), -1, 1e-9);       // looks back
  EXPECT_NEAR(walk.world_from_body(10 + 2 * turn + 1).translation().x(), 1, 1e-9);  // the next round
  EXPECT_TRUE(walk.walking(4));
  EXPECT_FALSE(walk.walking(1));
}

TEST(Motion, APersonIsSeenWhereTheyAreWithTheirClass) {
  Plan plan = still_plan();
  plan.movers.push_back({"person", "A", "walk", {{4.0, 1.0}, {4.0, 3.0}}, 1.0, 0.0, 0, 3});
  const Scene scene = build_scene(plan);
  Renderer renderer(scene, small_camera(), NoiseOptions::none());
  const auto middle_of = [&](int index) {
    const RenderedFrame frame = renderer.render(index);
    double sum = 0, count = 0;
    for (int u = 0; u < 160; ++u)
      for (int v = 40; v < 80; ++v)
        if (label_at(frame, u, v) == SceneClass::person) sum += u, ++count;
    EXPECT_GT(count, 100);
    return sum / count;
  };
  EXPECT_GT(middle_of(9), middle_of(45) + 40);  // from the right (y = 1.3) to the left (y = 2.5)
  EXPECT_EQ(scene.instances[scene.moving[0]].label, SceneClass::person);
}

TEST(Motion, TheRobotStaysInView) {
  Plan plan = testing::two_rooms_plan();
  plan.boxes.clear();
  plan.path.eye_height = 0.3;
  plan.path.robot = RobotPlan{};
  const Scene scene = build_scene(plan);
  Renderer renderer(scene, small_camera(), NoiseOptions::none());
  const RenderedFrame a = renderer.render(0), b = renderer.render(100);
  EXPECT_EQ(label_at(a, 80, 117), SceneClass::robot);
  for (int u = 20; u < 140; u += 10) EXPECT_NEAR(a.depth.at(u, 117), b.depth.at(u, 117), 2);
}

TEST(SlopedCeilings, ComeDownToTheirKnee) {
  Plan plan = still_plan();
  plan.rooms[0].slope = SlopePlan{1, 1.4, 1.8};
  plan.path.pitch_deg = 20;
  const Scene scene = build_scene(plan);
  const RenderedFrame frame = Renderer(scene, small_camera(), NoiseOptions::none()).render(30);
  const Camera camera = small_camera();
  int on_slope = 0;
  for (int v = 0; v < 120; v += 3) {
    for (int u = 0; u < 160; u += 3) {
      ASSERT_GT(frame.depth.at(u, v), 0);
      if (label_at(frame, u, v) != SceneClass::ceiling) continue;
      const Eigen::Vector3d p =
          frame.world_from_camera * camera.unproject(u, v, frame.depth.at(u, v) / camera.depth_scale);
      EXPECT_NEAR(p.z(), std::min(2.6, 1.4 + (5 - p.x()) * 1.2 / 1.8), 2e-3);
      on_slope += p.z() < 2.5;
    }
  }
  EXPECT_GT(on_slope, 100);
}

}  // namespace
}  // namespace vsgraphs
