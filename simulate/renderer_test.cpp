#include "simulate/renderer.h"

#include <gtest/gtest.h>

#include "core/base/check.h"
#include "simulate/test_plan.h"

namespace vsgraphs {
namespace {

using testing::small_camera;
using testing::two_rooms_plan;

// What a ray meets in the plan of testing.h, by hand: distance along z and the class.
struct Hit {
  double depth = 1e9;
  SceneClass label = SceneClass::none;
};

void meet(Hit& hit, double t, SceneClass label, bool inside) {
  if (inside && t > 1e-9 && t < hit.depth) hit = {t, label};
}

// Both rooms as solid boxes with the door cut out, and the box; no casing (the caller skips pixels near it).
Hit cast(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) {
  Hit hit;
  const auto at = [&](double t) -> Eigen::Vector3d { return eye + t * ray; };
  const auto in_door = [](const Eigen::Vector3d& p) { return p.y() > 1.5 && p.y() < 2.5 && p.z() < 2.0; };
  for (const double x0 : {0.0, 5.2}) {
    const double x1 = x0 == 0.0 ? 5.0 : 9.2;
    for (const double x : {x0, x1}) {
      const double t = (x - eye.x()) / ray.x();
      const Eigen::Vector3d p = at(t);
      const bool towards = (x == x1) == (ray.x() > 0);
      const bool open = (x == 5.0 || x == 5.2) && in_door(p);
      meet(hit, t, SceneClass::wall,
           towards && !open && p.y() >= 0 && p.y() <= 4 && p.z() >= 0 && p.z() <= 2.6);
    }
    for (const double y : {0.0, 4.0}) {
      const double t = (y - eye.y()) / ray.y();
      const Eigen::Vector3d p = at(t);
      meet(hit, t, SceneClass::wall, p.x() >= x0 && p.x() <= x1 && p.z() >= 0 && p.z() <= 2.6);
    }
    for (const double z : {0.0, 2.6}) {
      const double t = (z - eye.z()) / ray.z();
      const Eigen::Vector3d p = at(t);
      meet(hit, t, z == 0.0 ? SceneClass::floor : SceneClass::ceiling,
           p.x() >= x0 && p.x() <= x1 && p.y() >= 0 && p.y() <= 4);
    }
  }
  const double t = -eye.z() / ray.z();  // the ground in the doorway
  meet(hit, t, SceneClass::floor, at(t).x() > 5.0 && at(t).x() < 5.2 && in_door(at(t)));
  const Eigen::Vector3d low(2.7, 2.9, 0), high(3.3, 3.5, 0.6);
  for (int k = 0; k < 3; ++k) {
    for (const double side : {low[k], high[k]}) {
      const double to_side = (side - eye[k]) / ray[k];
      const Eigen::Vector3d p = at(to_side);
      bool inside = true;
      for (int j = 0; j < 3; ++j) inside = inside && (j == k || (p[j] >= low[j] && p[j] <= high[j]));
      meet(hit, to_side, SceneClass::misc, inside);
    }
  }
  return hit;
}

TEST(Renderer, CleanDepthAndClassesAreThoseOfTheGeometry) {
  Plan plan = two_rooms_plan();
  for (RoomPlan& room : plan.rooms) room.lamps.emplace();  // lamps would hang in the way
  const Scene scene = build_scene(plan);
  const Camera camera = small_camera();
  Renderer renderer(scene, camera, NoiseOptions::none());
  const RenderedFrame frame = renderer.render(10);
  int compared = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const auto label = static_cast<SceneClass>(frame.label.at(u, v));
      if (label == SceneClass::door) continue;  // lining and casing are not in the hand-made scene
      const Eigen::Vector3d in_camera((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
      const Hit hit =
          cast(frame.world_from_camera.translation(), frame.world_from_camera.rotation() * in_camera);
      const double units = hit.depth * camera.depth_scale;
      EXPECT_EQ(label, hit.label) << u << "," << v;
      EXPECT_LE(std::abs(frame.depth.at(u, v) - units), 0.5 + 1e-6) << u << "," << v;
      ++compared;
    }
  }
  EXPECT_GT(compared, 0.9 * camera.width * camera.height);
}

TEST(Renderer, SeesNoGapsAnywhereOnTheWay) {
  const Scene scene = build_scene(two_rooms_plan());
  Renderer renderer(scene, small_camera(), NoiseOptions::none());
  for (int i = 0; i < renderer.frame_count(); i += 7) {
    const RenderedFrame frame = renderer.render(i);
    for (const std::uint8_t label : frame.label.pixels) ASSERT_NE(label, 0) << "frame " << i;
    for (const std::uint16_t depth : frame.depth.pixels) ASSERT_GT(depth, 0) << "frame " << i;
  }
}

TEST(Renderer, InstancesBelongToTheirClasses) {
  const Scene scene = build_scene(two_rooms_plan());
  Renderer renderer(scene, small_camera(), NoiseOptions::none());
  const RenderedFrame frame = renderer.render(10);
  for (std::size_t i = 0; i < frame.instance.pixels.size(); ++i) {
    const Instance& instance = scene.instances[frame.instance.pixels[i]];
    const auto label = static_cast<SceneClass>(frame.label.pixels[i]);
    ASSERT_EQ(instance.label, label);
  }
}

TEST(Renderer, FramesDoNotDependOnTheirOrder) {
  const Scene scene = build_scene(two_rooms_plan());
  NoiseOptions noise;
  noise.seed = 5;
  Renderer forward(scene, small_camera(), noise), backward(scene, small_camera(), noise);
  const RenderedFrame a1 = forward.render(3), a2 = forward.render(20);
  const RenderedFrame b2 = backward.render(20), b1 = backward.render(3);
  EXPECT_EQ(a1.rgb.pixels, b1.rgb.pixels);
  EXPECT_EQ(a1.depth.pixels, b1.depth.pixels);
  EXPECT_EQ(a2.rgb.pixels, b2.rgb.pixels);
  EXPECT_EQ(a2.depth.pixels, b2.depth.pixels);
  noise.seed = 6;
  Renderer other(scene, small_camera(), noise);
  const RenderedFrame c1 = other.render(3);
  EXPECT_NE(a1.rgb.pixels, c1.rgb.pixels);
  EXPECT_NE(a1.depth.pixels, c1.depth.pixels);
  EXPECT_EQ(a1.label.pixels, c1.label.pixels);  // the truth is not the noise's business
  EXPECT_EQ(a1.world_from_camera.matrix(), c1.world_from_camera.matrix());
}

TEST(Renderer, BlurSmearsOnlyWhileMoving) {
  Plan plan = two_rooms_plan();
  plan.path.waypoints[1].at = {1.2, 2};
  plan.path.waypoints[1].yaw_deg = 150;
  plan.path.turn_rate = 90;
  plan.posters.push_back({"A", 0, 2.5, 1.4, 1.2, 0.9, "board", 1});
  plan.posters.push_back({"A", 2, 2.5, 1.4, 1.2, 0.9, "board", 1});
  const Scene scene = build_scene(plan);
  NoiseOptions blur = NoiseOptions::none();
  blur.motion_blur = true;
  blur.exposure_time_s = 0.03;
  Renderer sharp(scene, small_camera(), NoiseOptions::none()), smeared(scene, small_camera(), blur);
  const auto detail = [](const Image<Rgb>& image) {
    double sum = 0;
    for (int v = 0; v < image.height; ++v)
      for (int u = 1; u < image.width; ++u) sum += std::abs(image.at(u, v).g - image.at(u - 1, v).g);
    return sum;
  };
  EXPECT_NEAR(detail(smeared.render(0).rgb) / detail(sharp.render(0).rgb), 1.0, 0.02);
  const int turning = sharp.frame_count() / 2;
  EXPECT_LT(detail(smeared.render(turning).rgb), 0.9 * detail(sharp.render(turning).rgb));
}

TEST(Renderer, RefusesWhatItCannotDo) {
  const Scene scene = build_scene(two_rooms_plan());
  Camera fisheye = small_camera();
  fisheye.distortion[0] = -0.2;
  EXPECT_THROW(Renderer(scene, fisheye, NoiseOptions()), InputError);
  NoiseOptions wrong;
  wrong.baseline_m = -1;
  EXPECT_THROW(Renderer(scene, small_camera(), wrong), InputError);
  Renderer renderer(scene, small_camera(), NoiseOptions());
  EXPECT_THROW(renderer.render(-1), InputError);
  EXPECT_THROW(renderer.render(renderer.frame_count()), InputError);
}

}  // namespace
}  // namespace vsgraphs
