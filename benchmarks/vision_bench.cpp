// Cost of what a frame pays for features and matching: 640x480, 1000 features, one thread. CPU time counts.
#include <benchmark/benchmark.h>

#include <memory>
#include <numeric>
#include <vector>

#include "core/base/rng.h"
#include "core/vision/grey.h"
#include "core/vision/matching.h"
#include "core/vision/orb_extractor.h"
#include "core/vision/place_index.h"
#include "core/vision/test_images.h"

namespace vsgraphs {
namespace {

struct Views {
  Camera camera;
  Image<std::uint8_t> first = test::textured_image(640, 480, 1);
  Image<std::uint8_t> second = test::warped(first, test::similarity(first, 0.05, 1.03, {6, -4}));
  Image<float> depth{640, 480, 2.0f};
  OrbExtractor extractor{{}, camera};
  FeatureSet extract(const Image<std::uint8_t>& image) {
    return extractor.extract(image.view(), {{}, depth.view()}, {});
  }
};

void BM_grey(benchmark::State& state) {
  const Image<Rgb> colour(640, 480, Rgb{10, 20, 30});
  Image<std::uint8_t> grey;
  for (auto _ : state) {
    to_grey(colour.view(), grey);
    benchmark::DoNotOptimize(grey.pixels.data());
  }
}
BENCHMARK(BM_grey)->Unit(benchmark::kMicrosecond);

void BM_pyramid(benchmark::State& state) {
  const Image<std::uint8_t> image = test::textured_image(640, 480, 1);
  GreyPyramid pyramid({}, 640, 480);
  for (auto _ : state) pyramid.build(image.view());
}
BENCHMARK(BM_pyramid)->Unit(benchmark::kMicrosecond);

void BM_fast(benchmark::State& state) {
  const Image<std::uint8_t> image = test::textured_image(640, 480, 1);
  FastCorners fast;
  std::vector<Corner> corners;
  for (auto _ : state) fast.detect(image.view(), 7, 16, corners);
  state.counters["corners"] = static_cast<double>(corners.size());
}
BENCHMARK(BM_fast)->Unit(benchmark::kMicrosecond);

void BM_extract(benchmark::State& state) {
  Views views;
  for (auto _ : state) benchmark::DoNotOptimize(views.extract(views.first));
}
BENCHMARK(BM_extract)->Unit(benchmark::kMillisecond);

void BM_match_projected(benchmark::State& state) {
  Views views;
  const FeatureSet a = views.extract(views.first), b = views.extract(views.second);
  std::vector<ProjectedPoint> points;
  for (int i = 0; i < a.size(); ++i) {
    ProjectedPoint point;
    point.u = a[i].u;
    point.v = a[i].v;
    point.radius_px = 15;
    point.min_level = a[i].level - 1;
    point.max_level = a[i].level + 1;
    point.descriptor = &a.descriptor(i);
    points.push_back(point);
  }
  for (auto _ : state) benchmark::DoNotOptimize(match_projected(points, b, {}));
}
BENCHMARK(BM_match_projected)->Unit(benchmark::kMicrosecond);

void BM_match_descriptors(benchmark::State& state) {
  Views views;
  const FeatureSet a = views.extract(views.first), b = views.extract(views.second);
  for (auto _ : state) benchmark::DoNotOptimize(match_descriptors(a, b, {}));
}
BENCHMARK(BM_match_descriptors)->Unit(benchmark::kMillisecond);

void BM_match_epipolar(benchmark::State& state) {
  Views views;
  const FeatureSet a = views.extract(views.first), b = views.extract(views.second);
  std::vector<int> indices(static_cast<std::size_t>(std::min(a.size(), b.size())));
  std::iota(indices.begin(), indices.end(), 0);
  Eigen::Matrix3d sideways;
  sideways << 0, 0, 0, 0, 0, -1, 0, 1, 0;
  for (auto _ : state) benchmark::DoNotOptimize(match_epipolar(a, indices, b, indices, sideways, {}, 2, {}));
}
BENCHMARK(BM_match_epipolar)->Unit(benchmark::kMicrosecond);

// What keyframe `number` of a walk sees: a thousand looks, of which the next one shares 19 in 20; two views differ in
// one bit of eight.
FeatureSet walk_view(int number) {
  std::vector<Feature> features(1000);
  std::vector<Descriptor> descriptors(features.size());
  Rng flips(2, "walk", static_cast<std::uint64_t>(number));
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    Rng look(1, "look", i + 50 * static_cast<std::uint64_t>(number));
    for (std::uint64_t& word : descriptors[i].words)
      word = look.next() ^ (flips.next() & flips.next() & flips.next() & flips.next());
  }
  return {std::move(features), std::move(descriptors), 640, 480};
}

PlaceIndex& index_of_2000() {
  static PlaceIndex index = [] {
    PlaceIndex made;
    for (std::uint32_t k = 0; k < 2000; ++k) made.add({k, 0}, walk_view(static_cast<int>(k)));
    return made;
  }();
  return index;
}

void BM_place_index_query(benchmark::State& state) {
  const PlaceIndex& index = index_of_2000();
  const FeatureSet query = walk_view(700);
  for (auto _ : state) benchmark::DoNotOptimize(index.query(query, 10));
  state.counters["MB"] = static_cast<double>(index.bytes()) * 1e-6;
}
BENCHMARK(BM_place_index_query)->Unit(benchmark::kMillisecond);

void BM_place_index_build(benchmark::State& state) {
  std::vector<FeatureSet> views;
  for (int k = 0; k < 2000; ++k) views.push_back(walk_view(k));
  for (auto _ : state) {
    PlaceIndex index;
    for (std::uint32_t k = 0; k < 2000; ++k) index.add({k, 0}, views[k]);
    benchmark::DoNotOptimize(index.size());
  }
  state.counters["keyframes"] = 2000;
}
BENCHMARK(BM_place_index_build)->Unit(benchmark::kMillisecond)->Iterations(1);

void BM_place_index_copy(benchmark::State& state) {
  const PlaceIndex& index = index_of_2000();
  for (auto _ : state) benchmark::DoNotOptimize(std::make_shared<const PlaceIndex>(index));
}
BENCHMARK(BM_place_index_copy)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vsgraphs
