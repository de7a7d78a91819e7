// A walk through two simulated rooms and back, with everything on: what follows the map is what would be gathered from it, while the
// run goes on and when it has ended, and a second session goes on with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>

#include "core/system/maps/test_followers.h"
#include "core/system/run/slam.h"
#include "core/vision/grey.h"
#include "simulate/renderer.h"
#include "simulate/test_plan.h"

namespace vsgraphs {
namespace {

class SimulatedWalk {
 public:
  SimulatedWalk() : scene_(build_scene(plan())), renderer_(scene_, camera(), NoiseOptions::none()) {}

  static Camera camera() {
    Camera camera = testing::small_camera();
    camera.width *= 2;
    camera.height *= 2;
    camera.fx = camera.fy = 2 * camera.fx;
    camera.cx = 2 * camera.cx + 0.5;
    camera.cy = 2 * camera.cy + 0.5;
    camera.fps = plan().fps;
    return camera;
  }
  static Config config() {
    Config config;
    config.set("system.execution", "serial");
    config.set("mapper.stretch_way_m", 2.0);
    return config;
  }

  int frames() const { return renderer_.frame_count(); }
  static void show_darkness(std::int64_t index, Slam& slam) {
    const Image<std::uint8_t> grey(camera().width, camera().height, 0);
    const Image<std::uint16_t> depth(camera().width, camera().height, 0);
    show(grey, depth, index, slam);
  }
  // Frame `i` of the walk, as the run's frame `index`.
  TrackStatus show(int i, std::int64_t index, Slam& slam) const {
    const RenderedFrame seen = renderer_.render(i);
    return show(to_grey(seen.rgb.view()), seen.depth, index, slam);
  }

 private:
  static TrackStatus show(const Image<std::uint8_t>& grey, const Image<std::uint16_t>& depth,
                          std::int64_t index, Slam& slam) {
    RgbdFrame frame;
    frame.index = index;
    frame.timestamp_s = static_cast<double>(index) / plan().fps;
    frame.grey = grey.view();
    frame.depth.raw = depth.view();
    return slam.track(frame).status;
  }
  static Plan plan() {
    Plan plan = testing::two_rooms_plan();
    plan.fps = 5;
    plan.path.turn_rate = 25;
    for (const char* room : {"A", "B"}) {
      for (int wall = 0; wall < 4; ++wall) {
        for (const double along : {0.5, 1.25, 2.0, 2.75, 3.5}) {
          PosterPlan poster;
          poster.room = room;
          poster.wall = wall;
          poster.along = along;
          poster.seed = plan.posters.size();
          const bool before_the_door = std::abs(along - 2.0) < 1 && wall == (*room == 'A' ? 1 : 3);
          if (!before_the_door) plan.posters.push_back(poster);
        }
      }
    }
    plan.path.waypoints.clear();
    // Through the door, all around, and back.
    const std::vector<Eigen::Vector3d> way{{1.2, 2, 0},   {4, 2, 0},     {7.2, 2, 0},   {7.2, 2, 120},
                                           {7.2, 2, 240}, {7.2, 2, 300}, {7.2, 2, 180}, {4, 2, 180},
                                           {2.5, 2, 180}, {2.5, 2, 60},  {2.5, 2, -60}};
    plan.path.waypoints.resize(way.size());
    for (std::size_t i = 0; i < way.size(); ++i) {
      plan.path.waypoints[i].at = way[i].head<2>();
      plan.path.waypoints[i].yaw_deg = way[i].z();
    }
    return plan;
  }

  Scene scene_;
  mutable Renderer renderer_;
};

void expect_followers_like_gathered(const Slam& slam) {
  for (const MapState& state : slam.atlas_state().maps)
    test::expect_followers_like_gathered(state, SimulatedWalk::config(), SimulatedWalk::camera());
}

class Told : public MapListener {
 public:
  void keyframe_made(KeyframeId keyframe, const Snapshot& map) override {
    EXPECT_TRUE(map->keyframes().contains(keyframe));
    ++keyframes;
  }
  void room_found(RoomNumber room, const Snapshot& map) override {
    const auto& rooms = map->structure().rooms;
    EXPECT_TRUE(
        std::any_of(rooms.begin(), rooms.end(), [room](const FoundRoom& r) { return r.number == room; }));
    EXPECT_TRUE(found.insert(room).second) << "told once";
  }
  void loop_decided(const LoopDecision& decision, const Snapshot& map) override {
    EXPECT_TRUE(map->keyframes().contains(decision.report.keyframe));
    ++decided;
    joined += decision.accepted && decision.of_maps;
  }

  int keyframes = 0, decided = 0, joined = 0;
  std::set<RoomNumber> found;
};

TEST(SimulatedWalk, WhatFollowsTheMapIsWhatWouldBeGathered) {
  const SimulatedWalk walk;
  const auto told = std::make_shared<Told>();
  Slam slam(SimulatedWalk::config(), SimulatedWalk::camera(), {}, told);
  for (int i = 0; i < walk.frames(); ++i) {
    const TrackStatus status = walk.show(i, i, slam);
    EXPECT_TRUE(status == TrackStatus::ok || status == TrackStatus::initialised) << i;
    if (i % (walk.frames() / 3) == 0) expect_followers_like_gathered(slam);
  }
  slam.finish();
  expect_followers_like_gathered(slam);

  EXPECT_EQ(told->found.size(), slam.snapshot()->structure().next_number);
  EXPECT_FALSE(told->found.empty());

  const AtlasState known = slam.atlas_state();
  ASSERT_EQ(known.maps.size(), 1U);
  const auto& space = *known.maps[0].followers.find<SpaceKeeper>();
  EXPECT_GT(space.parts().size(), 2U) << "several stretches";
  EXPECT_GT(space.voxels().blocks().size(), 100U);
  EXPECT_GT(known.maps[0].map->planes().size(), 6U);
  EXPECT_TRUE(known.maps[0].map->up_in_world().has_value());
  Slam again(SimulatedWalk::config(), SimulatedWalk::camera(), known);
  for (int i = 0; i < walk.frames() / 2; ++i) walk.show(i, walk.frames() + i, again);
  again.finish();
  expect_followers_like_gathered(again);
}

class Deaf : public MapListener {
 public:
  void keyframe_made(KeyframeId, const Snapshot&) override { throw std::runtime_error("not now"); }
};

// Carried in the dark from the first room into the second, and walked back into the first.
TEST(SimulatedWalk, AfterAJoinToo) {
  const SimulatedWalk walk;
  const auto told = std::make_shared<Told>();
  Slam slam(SimulatedWalk::config(), SimulatedWalk::camera(), {}, told);
  std::int64_t index = 0;
  for (int i = 0; i < 30; ++i) walk.show(i, index++, slam);
  for (int i = 0; i < 20; ++i) SimulatedWalk::show_darkness(index++, slam);
  for (int i = walk.frames() / 2; i >= 0; --i) walk.show(i, index++, slam);
  slam.finish();
  EXPECT_EQ(slam.statistics().merges, 1);
  expect_followers_like_gathered(slam);
  EXPECT_EQ(told->joined, 1);
  EXPECT_GT(told->decided, 1);
  EXPECT_GT(told->keyframes, 10);
}

TEST(SimulatedWalk, AListenerThatFailsIsToldNothingMore) {
  const SimulatedWalk walk;
  Config config = SimulatedWalk::config();
  config.system.stop_on_fault = false;
  Slam slam(config, SimulatedWalk::camera(), {}, std::make_shared<Deaf>());
  for (int i = 0; i < 5; ++i) walk.show(i, i, slam);
  slam.finish();
  EXPECT_GT(slam.snapshot()->keyframes().size(), 0U);
  ASSERT_EQ(slam.statistics().warnings.size(), 1U);
  EXPECT_NE(slam.statistics().warnings[0].find("not now"), std::string::npos);
}

}  // namespace
}  // namespace vsgraphs
