// What a keyframe costs in a map that grows: nothing of it may hang on all that was ever seen. CPU time of one thread.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "core/map/test_map.h"
#include "core/scene/space/space_keeper.h"
#include "core/scene/surfaces/test_surfaces.h"
#include "core/solve/window.h"
#include "core/system/maps/atlas_file.h"
#include "core/system/maps/followers.h"
#include "core/system/maps/map_owner.h"
#include "core/understanding/scene_builder.h"

namespace vsgraphs {
namespace {

// A corridor along x that the camera goes up and down, 0.25 m from keyframe to keyframe.
class Corridor {
 public:
  Corridor(const test::World& world, int one_way) : world_(world), one_way_(one_way) {
    apply({map_.version(), {vsgraphs::SetUp{Eigen::Vector3d::UnitZ()}}});
  }

  int size() const { return static_cast<int>(map_.keyframes().index_bound()); }
  Map& map() { return map_; }
  const Followers& followers() const { return followers_; }

  // Without planes yet.
  KeyframeId go_on() {
    const int i = size();
    const bool back = i / one_way_ % 2 == 1;
    const int along = i % one_way_;
    const double x = 0.25 * (back ? one_way_ - along : along);
    const Se3 pose =
        test::looking({x, 0.05 * (i % 3), 1.4}, {x + (back ? -2.0 : 2.0), i % 2 ? 0.8 : -0.8, 1.1});
    Keyframe keyframe = test::keyframe_seeing(camera_, pose, {});
    keyframe.frame_index = i;
    keyframe.surface = std::make_shared<const DepthGrid>(test::view(near(x), pose, camera_));
    if (i % 60 != 0) keyframe.stretch = map_.stretch_of(newest_);
    newest_ = map_.keyframes().next_id();
    apply({map_.version(), {AddKeyframe{newest_, keyframe}}});
    return newest_;
  }
  // All that a keyframe brings about with planes: seen, associated, followed, judged, and their part of a window.
  void understand() {
    const SurfaceKeeper& surfaces = *followers_.find<SurfaceKeeper>();
    apply(builder_.associate(newest_, map_.snapshot(), surfaces, nullptr, nullptr));
    apply(builder_.interpret(newest_, map_.snapshot(), surfaces, nullptr));
    Window window;
    for (std::uint32_t back = 0; back < 25; ++back)
      (back < 15 ? window.free : window.fixed).push_back(map_.keyframes().at_index(newest_.index - back));
    benchmark::DoNotOptimize(build_problem(map_, window, {camera_, 1.2, {}}));
  }
  void carve() { followers_.catch_up(map_, false, run); }

 private:
  // What can be seen from there: sheets that begin within 12 m, or are long.
  test::World near(double x) const {
    test::World near;
    for (const auto& sheet : world_.sheets)
      if (std::abs(sheet.corner.x() - x) < 12 || sheet.a.norm() > 12 || sheet.b.norm() > 12)
        near.sheets.push_back(sheet);
    return near;
  }
  static bool run(const char*, const std::function<void()>& work) { return work(), true; }
  void apply(const MapEdit& edit) {
    const Snapshot before = map_.snapshot();
    map_.apply(edit);
    followers_.follow(*before, edit, map_, nullptr, run);
  }

  Camera camera_;
  test::World world_;
  int one_way_;
  Map map_;
  Followers followers_ = make_followers(Config{}, camera_);
  SceneBuilder builder_{SceneBuilderOptions{}, camera_};
  KeyframeId newest_;
};

void walk(Corridor& corridor, int keyframes) {
  while (corridor.size() < keyframes) {
    corridor.go_on();
    if (corridor.size() > 25) corridor.understand();
    if (corridor.size() % 8 == 0) corridor.carve();
  }
}

// Of four planes; one for all sizes, which are asked for in ascending order.
Corridor& corridor(int keyframes) {
  static Corridor corridor(test::World().room({-6, -1, 0}, {66, 1, 2.5}), 240);
  walk(corridor, keyframes);
  return corridor;
}

// Of 500 planes: walls of 1.5 m, each set back against its neighbours.
Corridor& building() {
  static Corridor building = [] {
    test::World world;
    world.sheet({-6, -2, 0}, {390, 0, 0}, {0, 4, 0});
    for (int i = -4; i < 256; ++i) {
      const double back_m = 0.25 * (i & 3), x = 1.5 * i;
      world.sheet({x, 1 + back_m, 0}, {1.5, 0, 0}, {0, 0, 2.5});
      world.sheet({x, -1 - back_m, 0}, {1.5, 0, 0}, {0, 0, 2.5});
    }
    Corridor corridor(world, 1500);
    walk(corridor, 3000);
    return corridor;
  }();
  return building;
}

void BM_planes_of_a_keyframe(benchmark::State& state) {
  Corridor& map = corridor(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    state.PauseTiming();
    map.go_on();
    state.ResumeTiming();
    map.understand();
  }
}
BENCHMARK(BM_planes_of_a_keyframe)
    ->Arg(250)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Iterations(40)
    ->Unit(benchmark::kMillisecond);

void BM_space_of_a_keyframe(benchmark::State& state) {
  Corridor& map = corridor(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    state.PauseTiming();
    map.go_on();
    state.ResumeTiming();
    map.carve();
  }
}

void BM_planes_of_a_keyframe_in_a_building(benchmark::State& state) {
  Corridor& map = building();
  for (auto _ : state) {
    state.PauseTiming();
    map.go_on();
    state.ResumeTiming();
    map.understand();
  }
}
BENCHMARK(BM_planes_of_a_keyframe_in_a_building)->Iterations(40)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_space_of_a_keyframe)->Arg(2100)->Iterations(40)->Unit(benchmark::kMillisecond);

// What a run waits for before its first frame when it goes on in an atlas: all followers come with it.
void BM_start_from_an_atlas(benchmark::State& state) {
  Corridor& made = building();
  const AtlasState known{{{made.map().snapshot(), made.followers().copy()}}, {}};
  for (auto _ : state) {
    SnapshotCell cell;
    benchmark::DoNotOptimize(MapOwner(Config{}, Camera{}, cell, known).version());
  }
  state.counters["keyframes"] = made.size();
  state.counters["planes"] = static_cast<double>(made.map().planes().size());
}
BENCHMARK(BM_start_from_an_atlas)->Iterations(5)->Unit(benchmark::kMillisecond);

// For how long mapping waits while an atlas is saved beside it.
void BM_maps_to_save(benchmark::State& state) {
  Corridor& made = building();
  const AtlasState known{{{made.map().snapshot(), made.followers().copy()}}, {}};
  SnapshotCell cell;
  const MapOwner owner(Config{}, Camera{}, cell, known);
  for (auto _ : state) benchmark::DoNotOptimize(owner.maps());
}
BENCHMARK(BM_maps_to_save)->Iterations(20)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vsgraphs
