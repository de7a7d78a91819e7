#include "core/vision/depth_sampling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/vision/test_rooms.h"

namespace vsgraphs {
namespace {

using namespace test;

constexpr int step = 8, reach = 2;

Camera small_camera() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 262.5;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

DepthGrid sampled(const Camera& camera, const Image<float>& depth) {
  return DepthSampler(camera).sample(view_of(depth));
}

int with_normal(const DepthGrid& grid) {
  int count = 0;
  for (const SurfaceSample& sample : grid.samples) count += sample.has_normal();
  return count;
}

TEST(DepthSampling, SamplesAreThePointsOfTheirPixels) {
  const Camera camera = small_camera();
  const DepthGrid grid = sampled(camera, Image<float>(320, 240, 2.0F));
  ASSERT_EQ(grid.columns, 40);
  ASSERT_EQ(grid.rows, 30);
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; ++c)
      EXPECT_TRUE(grid.at(c, r).point.cast<double>().isApprox(
          camera.unproject(c * step + 4, r * step + 4, 2.0), 1e-6));
}

TEST(DepthSampling, APlanesNormalsPointAtTheCamera) {
  const Camera camera = small_camera();
  const Wall wall{Eigen::Vector3d(0.4, -0.3, 1).normalized(), 2.0};
  const DepthGrid grid = sampled(camera, depth_of_room(camera, Se3{}, {wall}));
  EXPECT_EQ(with_normal(grid), (40 - 2 * reach) * (30 - 2 * reach));
  for (const SurfaceSample& sample : grid.samples) {
    EXPECT_NEAR(wall.normal.dot(sample.point.cast<double>()), wall.offset_m, 1e-4);
    if (sample.has_normal()) {
      EXPECT_LT((sample.normal.cast<double>() + wall.normal).norm(), 1e-3);
    }
  }
}

TEST(DepthSampling, NoNormalAcrossAFold) {
  const Camera camera = small_camera();
  const auto room = corner_room();
  const DepthGrid grid = sampled(camera, depth_of_room(camera, Se3{}, room));
  std::vector<int> of_wall(room.size());
  for (const SurfaceSample& sample : grid.samples) {
    if (!sample.has_normal()) continue;
    bool some = false;
    for (std::size_t w = 0; w < room.size(); ++w) {
      const bool here = (sample.normal.cast<double>() + room[w].normal).norm() < 0.35;
      of_wall[w] += here;
      some = some || here;
    }
    EXPECT_TRUE(some) << "the normal " << sample.normal.transpose() << " is no wall's";
  }
  for (const int count : of_wall) EXPECT_GT(count, 30);
  EXPECT_LT(with_normal(grid), (40 - 2 * reach) * (30 - 2 * reach));
}

TEST(DepthSampling, NoNormalAcrossAStep) {
  const Camera camera = small_camera();
  Image<float> depth(320, 240, 2.0F);
  constexpr int edge_column = 20;
  for (int v = 0; v < 240; ++v)
    for (int u = edge_column * step; u < 320; ++u) depth.at(u, v) = 2.2F;
  const DepthGrid grid = sampled(camera, depth);
  for (int c = reach; c < grid.columns - reach; ++c) {
    const bool near_edge = c >= edge_column - reach && c < edge_column + reach;
    EXPECT_EQ(grid.at(c, 15).has_normal(), !near_edge) << "column " << c;
    EXPECT_FLOAT_EQ(grid.at(c, 15).point.z(), c < edge_column ? 2.0F : 2.2F);
  }
}

TEST(DepthSampling, HolesHaveNoPointAndNoNormalAroundThem) {
  const Camera camera = small_camera();
  Image<float> depth(320, 240, 2.0F);
  depth.at(20 * step + 4, 15 * step + 4) = 0.0F;
  depth.at(10 * step + 4, 15 * step + 4) = std::nanf("");
  const DepthGrid grid = sampled(camera, depth);
  for (const int column : {10, 20}) {
    EXPECT_EQ(grid.at(column, 15).point.z(), 0.0F);
    for (const int off : {-reach, 0, reach}) EXPECT_FALSE(grid.at(column + off, 15).has_normal());
    EXPECT_TRUE(grid.at(column + 1, 15).has_normal());
  }
}

TEST(DepthSampling, NoiseIsAveragedButTheOtherSurfaceIsLeftOut) {
  const Camera camera = small_camera();
  Image<float> depth(320, 240, 2.0F);
  const int u = 20 * step + 4, v = 15 * step + 4;
  depth.at(u, v) = 2.009F;
  EXPECT_NEAR(sampled(camera, depth).at(20, 15).point.z(), 2.001F, 1e-5);
  depth.at(u + 1, v) = depth.at(u + 1, v + 1) = 2.5F;
  depth.at(u - 1, v) = 0.0F;
  EXPECT_NEAR(sampled(camera, depth).at(20, 15).point.z(), 2.0F + 0.009F / 6, 1e-5);
}

TEST(DepthSampling, GrazingSurfacesHaveNoNormal) {
  const Camera camera = small_camera();
  const DepthGrid grid = sampled(camera, depth_of_room(camera, Se3{}, {{Eigen::Vector3d(0, 1, 0), 0.3}}));
  int grazing = 0, steep = 0;
  for (int r = reach; r < grid.rows - reach; ++r) {
    const SurfaceSample& sample = grid.at(20, r);
    const float cosine = sample.point.y() / std::max(1e-6F, sample.point.norm());
    if (sample.point.z() <= 0 || grid.at(20, r - reach).point.z() <= 0 || std::abs(cosine - 0.2F) < 0.01F)
      continue;
    EXPECT_EQ(sample.has_normal(), cosine > 0.2F) << "row " << r;
    (cosine > 0.2F ? steep : grazing) += 1;
  }
  EXPECT_GT(grazing, 2);
  EXPECT_GT(steep, 3);
}

TEST(DepthSampling, LookUpFindsTheSampleWhereAPointAppears) {
  Camera lens = small_camera();
  lens.distortion = {0.2, -0.5, 0.002, -0.001, 0.3};
  for (const Camera& camera : {small_camera(), lens}) {
    const DepthSampler sampler(camera);
    const Image<float> depth(320, 240, 2.0F);
    const DepthGrid grid = sampler.sample(view_of(depth));
    for (int r = 0; r < grid.rows; ++r)
      for (int c = 0; c < grid.columns; ++c)
        EXPECT_EQ(sampler.look_up(grid, 0.7 * grid.at(c, r).point.cast<double>()), &grid.at(c, r));
    EXPECT_EQ(sampler.look_up(grid, {0, 0, -2}), nullptr);
    EXPECT_EQ(sampler.look_up(grid, {0, 0, 0.01}), nullptr);
    EXPECT_EQ(sampler.look_up(grid, {3, 0, 2}), nullptr);
    EXPECT_EQ(sampler.look_up(grid, {0, -3, 2}), nullptr);
    EXPECT_EQ(sampler.look_up(grid, Eigen::Vector3d::Constant(std::nan(""))), nullptr);
  }
}

}  // namespace
}  // namespace vsgraphs
