#include "core/solve/pose_graph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/check.h"
#include "core/base/rng.h"

namespace vsgraphs {
namespace {

Matrix6d sigmas(double translation_m, double rotation_rad) {
  Vector6d diagonal;
  diagonal.head<3>().setConstant(1 / (translation_m * translation_m));
  diagonal.tail<3>().setConstant(1 / (rotation_rad * rotation_rad));
  return diagonal.asDiagonal();
}

// Cameras on a circle of 5 m, looking along it.
std::vector<Se3> circle(int count) {
  std::vector<Se3> poses;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const Eigen::Matrix3d turn = so3_exp({0, -angle, 0});
    poses.push_back({turn, turn * Eigen::Vector3d(5, 0, 0)});
  }
  return poses;
}

struct Ring {
  std::vector<Se3> truth;
  PoseGraph graph;
};

// Odometry that turns and climbs a little too much at every step; poses chained up from it.
Ring drifting_ring(int count) {
  Ring ring{circle(count), {}};
  Vector6d bias;
  bias << 0.02, 0.01, 0, 0, 0.02, 0;
  bias *= 10.0 / count;
  ring.graph.poses.push_back(ring.truth[0]);
  for (int i = 0; i + 1 < count; ++i) {
    const Se3 step =
        (ring.truth[static_cast<std::size_t>(i)].inverse() * ring.truth[static_cast<std::size_t>(i) + 1])
            .retract(bias);
    ring.graph.edges.push_back({i, i + 1, step, sigmas(0.01, 0.01), 0});
    ring.graph.poses.push_back(ring.graph.poses.back() * step);
  }
  ring.graph.pose_fixed.assign(ring.truth.size(), 0);
  ring.graph.pose_fixed[0] = 1;
  return ring;
}

double worst_error_m(const std::vector<Se3>& poses, const std::vector<Se3>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    worst = std::max(worst, (poses[i].translation() - truth[i].translation()).norm());
  return worst;
}

void close(Ring& ring) {
  const int last = static_cast<int>(ring.truth.size()) - 1;
  ring.graph.edges.push_back(
      {last, 0, ring.truth.back().inverse() * ring.truth.front(), sigmas(0.002, 0.002), 0});
}

class PoseGraphSizes : public ::testing::TestWithParam<int> {};

// 40 poses: dense; 400: sparse.
TEST_P(PoseGraphSizes, ALoopSpreadsTheDriftOverTheRing) {
  Ring ring = drifting_ring(GetParam());
  const double before = worst_error_m(ring.graph.poses, ring.truth);
  EXPECT_GT(before, 1.0);
  close(ring);
  const SolveReport report = optimise_pose_graph(ring.graph, 30);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.final_cost, 0.05 * report.initial_cost);
  EXPECT_LT(worst_error_m(ring.graph.poses, ring.truth), 0.2 * before);
  EXPECT_EQ(ring.graph.poses[0].matrix(), ring.truth[0].matrix());
}
INSTANTIATE_TEST_SUITE_P(DenseAndSparse, PoseGraphSizes, ::testing::Values(40, 400));

TEST(PoseGraph, ExactEdgesGiveTheExactPoses) {
  const std::vector<Se3> truth = circle(30);
  PoseGraph graph;
  Rng rng(1, "pose_graph", 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    Vector6d noise;
    for (int k = 0; k < 6; ++k) noise[k] = i == 0 ? 0 : 0.1 * rng.normal();
    graph.poses.push_back(truth[i].retract(noise));
    graph.pose_fixed.push_back(i == 0);
    const std::size_t next = (i + 1) % truth.size();
    graph.edges.push_back({static_cast<int>(i), static_cast<int>(next), truth[i].inverse() * truth[next],
                           sigmas(0.01, 0.01), 0});
  }
  optimise_pose_graph(graph, 30);
  EXPECT_LT(worst_error_m(graph.poses, truth), 1e-6);
}

TEST(PoseGraph, ARobustWrongEdgeBendsLessThanAPlainOne) {
  const auto error_with = [](double huber_sigmas) {
    Ring ring = drifting_ring(40);
    close(ring);
    optimise_pose_graph(ring.graph, 30);
    const std::vector<Se3> good = ring.graph.poses;
    ring.graph.edges.push_back({10, 30, Se3{}, sigmas(0.01, 0.01), huber_sigmas});
    optimise_pose_graph(ring.graph, 30);
    return worst_error_m(ring.graph.poses, good);
  };
  EXPECT_LT(error_with(1.0), 0.4);
  EXPECT_GT(error_with(0), 1.0);
}

TEST(PoseGraph, StopsWhenTold) {
  Ring ring = drifting_ring(40);
  close(ring);
  const std::vector<Se3> before = ring.graph.poses;
  const SolveReport report = optimise_pose_graph(ring.graph, 30, [] { return true; });
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(worst_error_m(ring.graph.poses, before), 0);
}

TEST(PoseGraph, DirectionsAnEdgeSaysNothingOfStayFree) {
  PoseGraph graph;
  graph.poses = {Se3{}, Se3(Eigen::Matrix3d::Identity(), {1, 2, 3})};
  graph.pose_fixed = {1, 0};
  Matrix6d depth_only = sigmas(0.01, 0.01);
  depth_only(0, 0) = depth_only(1, 1) = 0;
  graph.edges.push_back({0, 1, Se3{}, depth_only, 0});
  optimise_pose_graph(graph, 30);
  EXPECT_NEAR(graph.poses[1].translation().z(), 0, 1e-3);
  EXPECT_NEAR(graph.poses[1].translation().x(), 1, 0.02);
}

TEST(PoseGraph, RefusesNegativeInformationAndIndicesOutOfRange) {
  PoseGraph graph;
  graph.poses = {Se3{}, Se3{}};
  graph.pose_fixed = {1, 0};
  graph.edges.push_back({0, 1, Se3{}, -Matrix6d::Identity(), 0});
  EXPECT_THROW(optimise_pose_graph(graph, 5), InputError);
  graph.edges[0] = {0, 2, Se3{}, Matrix6d::Identity(), 0};
  EXPECT_THROW(optimise_pose_graph(graph, 5), InputError);
}

}  // namespace
}  // namespace vsgraphs
