#include "core/solve/triangulate.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/solve/factors/jacobian_test.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

const Intrinsics intrinsics;
const Eigen::Vector3d target(0.4, -0.3, 3.0);

ViewOfPoint view_from(const Eigen::Vector3d& centre, const Eigen::Vector3d& point, bool depth,
                      Rng* rng = nullptr) {
  ViewOfPoint view;
  view.world_from_camera = Se3(so3_exp({0.02, -0.1 * centre.x(), 0.01}), centre);
  const Eigen::Vector3d p = view.world_from_camera.inverse() * point;
  const Eigen::Vector2d px = intrinsics.project(p);
  view.measurement.u = px.x() + (rng ? rng->normal() : 0.0);
  view.measurement.v = px.y() + (rng ? rng->normal() : 0.0);
  if (depth) {
    view.measurement.inv_sigma_inverse_depth = inv_sigma_of_inverse_depth(DepthNoise{}, p.z());
    view.measurement.inverse_depth =
        1 / p.z() + (rng ? rng->normal() / view.measurement.inv_sigma_inverse_depth : 0.0);
  }
  return view;
}

TEST(Triangulate, TwoExactViewsGiveThePoint) {
  const ViewOfPoint views[] = {view_from({0, 0, 0}, target, false), view_from({0.3, 0, 0}, target, false)};
  const auto point = triangulate(intrinsics, views);
  ASSERT_TRUE(point);
  EXPECT_LT((*point - target).norm(), 1e-9);
}

TEST(Triangulate, ErrorUnderNoiseIsThatOfTheOptimum) {
  Rng rng(1, "triangulate_test", 0);
  double linear_only = 0, refined = 0, with_depth = 0;
  int count = 0;
  TriangulationOptions none;
  none.refinement_steps = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<ViewOfPoint> views;
    for (double x : {0.0, 0.15, 0.3, 0.45})
      views.push_back(view_from({x, 0.05 * x, 0.8 * x}, target, false, &rng));
    const auto a = triangulate(intrinsics, views, none), b = triangulate(intrinsics, views);
    views.push_back(view_from({0.2, 0.1, 0}, target, true, &rng));
    const auto c = triangulate(intrinsics, views);
    if (!a || !b || !c) continue;  // a draw beyond the gate
    ++count;
    linear_only += (*a - target).squaredNorm();
    refined += (*b - target).squaredNorm();
    with_depth += (*c - target).squaredNorm();
  }
  EXPECT_GT(count, 300);
  EXPECT_LE(refined, 1.01 * linear_only);
  EXPECT_LT(with_depth, refined);
  // z^2 / (f b) with b^2 the sum of the squared distances of the views from their mean: 9 / (525 * 0.335) = 5 cm.
  EXPECT_NEAR(std::sqrt(refined / count), 0.048, 0.006);
}

TEST(Triangulate, OneViewWithDepthIsEnough) {
  const ViewOfPoint views[] = {view_from({0.1, 0, 0}, target, true)};
  const auto point = triangulate(intrinsics, views);
  ASSERT_TRUE(point);
  EXPECT_LT((*point - target).norm(), 1e-6);
}

TEST(Triangulate, RefusesTooLittle) {
  const ViewOfPoint one[] = {view_from({0, 0, 0}, target, false)};
  EXPECT_FALSE(triangulate(intrinsics, one));
  EXPECT_FALSE(triangulate(intrinsics, {}));
  const ViewOfPoint narrow[] = {view_from({0, 0, 0}, target, false), view_from({0.02, 0, 0}, target, false)};
  EXPECT_FALSE(triangulate(intrinsics, narrow));
  const ViewOfPoint same[] = {one[0], one[0], one[0]};
  EXPECT_FALSE(triangulate(intrinsics, same));
}

TEST(Triangulate, RefusesViewsThatDisagree) {
  ViewOfPoint views[] = {view_from({0, 0, 0}, target, false), view_from({0.3, 0, 0}, target, false)};
  views[1].measurement.v += 15;  // off the epipolar line
  EXPECT_FALSE(triangulate(intrinsics, views));
  ViewOfPoint depth[] = {view_from({0, 0, 0}, target, true), view_from({0.3, 0, 0}, target, true)};
  depth[1].measurement.inverse_depth *= 1.3;
  EXPECT_FALSE(triangulate(intrinsics, depth));
}

TEST(Triangulate, RefusesPointsBehind) {
  ViewOfPoint views[] = {view_from({0, 0, 0}, target, false), view_from({0.3, 0, 0}, target, false)};
  std::swap(views[0].measurement.u, views[1].measurement.u);  // rays that part meet behind
  EXPECT_FALSE(triangulate(intrinsics, views));
}

TEST(ParallaxAngle, IsTheAngleAtThePoint) {
  EXPECT_NEAR(parallax_angle({0, 0, 2}, {-2, 0, 0}, {2, 0, 0}), std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(parallax_angle({0, 0, 2}, {0, 0, 0}, {0, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(parallax_angle({0, 0, 2}, {0, 0, 0}, {0, 0, 4}), std::numbers::pi, 1e-12);
}

TEST(ReprojectionErrorOf, SeparatesPixelAndDepth) {
  const ViewOfPoint view = view_from({0, 0, 0}, target, true);
  ReprojectionMeasurement m = view.measurement;
  m.u += 3;
  m.inv_sigma_px = 0.5;
  const auto error = reprojection_error(intrinsics, view.world_from_camera, target, m);
  ASSERT_TRUE(error);
  EXPECT_NEAR(error->chi2_px, 2.25, 1e-9);
  EXPECT_NEAR(error->chi2_depth, 0, 1e-9);
  EXPECT_FALSE(reprojection_error(intrinsics, view.world_from_camera, {0, 0, -1}, m));
}

}  // namespace
}  // namespace vsgraphs
