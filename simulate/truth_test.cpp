#include "simulate/truth.h"

#include <gtest/gtest.h>

#include "simulate/renderer.h"
#include "simulate/test_plan.h"

namespace vsgraphs {
namespace {

using testing::small_camera;
using testing::two_rooms_plan;

TEST(Truth, CountsWhatFillsEnoughOfTheImage) {
  const Scene scene = build_scene(two_rooms_plan());
  ObservationCounter seen(scene);
  Image<std::uint16_t> image(100, 100, scene.walls[0].instance);
  for (int u = 0; u < 100; ++u) image.at(u, 0) = scene.walls[1].instance;                   // 1 %
  for (int u = 0; u < 100; ++u) image.at(u, 1) = image.at(u, 2) = scene.walls[2].instance;  // 2 %
  for (int i = 0; i < 6; ++i) seen.add(image, {1, 1, 1});
  EXPECT_EQ(seen.frames(), 6);
  EXPECT_EQ(seen.frames_seen(scene.walls[0].instance), 6);
  EXPECT_TRUE(seen.observed(scene.walls[0].instance));
  EXPECT_FALSE(seen.observed(scene.walls[1].instance));
  EXPECT_TRUE(seen.observed(scene.walls[2].instance));
  EXPECT_NEAR(seen.mean_share(scene.walls[1].instance), 0.01, 1e-12);
  EXPECT_TRUE(seen.visited(0));
  EXPECT_FALSE(seen.visited(1));
}

TEST(Truth, AWalkThroughTheDoorVisitsBothRooms) {
  const Scene scene = build_scene(two_rooms_plan());
  Renderer renderer(scene, small_camera(), NoiseOptions::none());
  ObservationCounter seen(scene);
  for (int i = 0; i < renderer.frame_count(); i += 10) {
    const RenderedFrame frame = renderer.render(i);
    seen.add(frame.instance, frame.world_from_camera.translation());
  }
  EXPECT_TRUE(seen.visited(0));
  EXPECT_TRUE(seen.visited(1));
  EXPECT_TRUE(seen.observed(scene.walls[5].instance));   // B's far wall
  EXPECT_FALSE(seen.observed(scene.walls[3].instance));  // A's wall behind the camera
}

}  // namespace
}  // namespace vsgraphs
