// Cost of a loop in a large map: 2,000 keyframes of about 500 landmarks each. One thread; CPU time counts.
#include <benchmark/benchmark.h>

#include "core/loops/loop_adjustment.h"
#include "core/loops/loop_closer.h"
#include "core/loops/test_loop_world.h"

namespace vsgraphs {
namespace {

// 33 turns in one room, each mapped anew.
const test::LoopWorld& hall() {
  static const test::LoopWorld world = [] {
    test::LoopWorldOptions options;
    options.keyframes = 2000;
    options.per_turn = 60;
    options.grids = options.patches = false;
    options.drift_per_step << 1e-5, 5e-5, 1e-5, 0, 1e-5, 0;
    return test::LoopWorld(options);
  }();
  return world;
}

const Snapshot& snapshot() {
  static const Snapshot made = std::make_shared<const Map>(hall().map);
  return made;
}

void BM_keyframe_graph(benchmark::State& state) {
  state.counters["edges"] = static_cast<double>(graph_of(*snapshot(), {}).edges.size());
  for (auto _ : state) benchmark::DoNotOptimize(graph_of(*snapshot(), {}));
}
BENCHMARK(BM_keyframe_graph)->Unit(benchmark::kMillisecond);

void BM_close_loop(benchmark::State& state) {
  LoopReport report;
  const Snapshot& map = snapshot();
  for (auto _ : state) {
    LoopCloser closer({}, hall().camera, hall().pyramid, 1);
    benchmark::DoNotOptimize(closer.close(hall().ids.back(), map, hall().places, report, nullptr));
  }
  state.SetLabel(to_string(report.verdict));
}
BENCHMARK(BM_close_loop)->Unit(benchmark::kMillisecond);

void BM_full_adjustment(benchmark::State& state) {
  for (auto _ : state) {
    FullAdjustment adjustment(snapshot(), {hall().camera, hall().pyramid.factor, {}});
    benchmark::DoNotOptimize(adjustment.run());
  }
}
BENCHMARK(BM_full_adjustment)->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace vsgraphs
