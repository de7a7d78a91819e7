#include "core/loops/loop_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/pose_covariance.h"
#include "core/loops/loop_checks.h"
#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using test::standing_at;

constexpr double rad_per_deg = std::numbers::pi / 180.0;

// A row of keyframes `step_m` apart; neighbours share `shared` landmarks.
struct Row {
  Map map;
  std::vector<KeyframeId> ids;
  Camera camera;

  Row(int keyframes, double step_m, int shared) {
    int name = 0;
    for (int k = 0; k < keyframes; ++k) {
      const Se3 pose = standing_at(step_m * k);
      const test::Points points = test::point_grid(3 * std::max(shared, 10), 1, step_m * k);
      Keyframe keyframe = test::keyframe_seeing(camera, pose, points);
      keyframe.frame_index = k;
      ids.push_back(test::add_keyframe(map, keyframe));
      if (k == 0) continue;
      for (int i = 0; i < shared; ++i)
        test::add_landmark(map, {step_m * k, 0, 2}, name++,
                           {{ids[ids.size() - 2], static_cast<std::uint16_t>(i)},
                            {ids.back(), static_cast<std::uint16_t>(shared + i)}});
    }
  }
};

bool has_edge(const KeyframeGraph& graph, int a, int b) {
  for (const KeyframeEdge& e : graph.edges)
    if ((e.a == a && e.b == b) || (e.a == b && e.b == a)) return true;
  return false;
}

TEST(LoopGraph, JoinsCovisibleKeyframesWithTheirPresentPoses) {
  const Row row(4, 0.3, 40);
  const KeyframeGraph graph = graph_of(row.map, {});
  ASSERT_EQ(graph.edges.size(), 3U);
  for (const KeyframeEdge& e : graph.edges) {
    EXPECT_EQ(e.shared, 40);
    EXPECT_NEAR(e.a_from_b.translation().x(), 0.3 * (e.b - e.a), 1e-12);
  }
}

TEST(LoopGraph, UsesTrackedLinksAndBridgesWhatIsLeft) {
  Row row(2, 0.3, 40);
  const auto lone = [&row](double x, std::int64_t frame) {
    Keyframe k = test::keyframe_seeing(row.camera, standing_at(x), test::point_grid(3, 3, x));
    k.frame_index = frame;
    return k;
  };
  Keyframe linked = lone(1, 10);
  linked.tracked_link = TrackedLink{row.ids[0], standing_at(0.9), 1e6 * Matrix6d::Identity()};
  test::add_keyframe(row.map, linked);
  test::add_keyframe(row.map, lone(2, 11));
  const KeyframeGraph graph = graph_of(row.map, {});
  ASSERT_EQ(graph.edges.size(), 3U);
  EXPECT_TRUE(has_edge(graph, 0, 2));
  EXPECT_TRUE(has_edge(graph, 2, 3)) << "one after the other in time";
  EXPECT_NEAR(graph.edges[1].a_from_b.translation().x(), 0.9, 1e-12) << "as tracked, not as mapped";
  EXPECT_GT(graph.edges[2].covariance.trace(), 5 * graph.edges[1].covariance.trace());
}

TEST(LoopGraph, GoesByMeasuredOdometryWhereTheMapContradictsIt) {
  Row row(3, 0.3, 40);
  Vector6d variances;
  variances << 1e-8, 1e-8, 4e-2, 1e-8, 1e-8, 1e-8;
  row.map.apply(SetOdometry{row.ids[1], {row.ids[0], standing_at(0.301), variances.asDiagonal()}});
  row.map.apply(SetOdometry{row.ids[2], {row.ids[1], standing_at(0.301), variances.asDiagonal()}});
  const auto first_step = [&row] {
    const KeyframeGraph graph = graph_of(row.map, {});
    EXPECT_EQ(graph.edges.size(), 2U);
    return graph.edges[graph.edges[0].a == 0 ? 0 : 1];
  };
  EXPECT_NEAR(first_step().a_from_b.translation().x(), 0.3, 1e-12) << "where they agree the map knows more";
  row.map.apply(MoveKeyframe{row.ids[1], standing_at(5)});
  row.map.apply(MoveKeyframe{row.ids[2], standing_at(5.3)});
  const KeyframeEdge edge = first_step();
  EXPECT_NEAR(edge.a_from_b.translation().x(), 0.301, 1e-12);
  EXPECT_NEAR(edge.covariance(2, 2), 4e-2, 1e-12);
  const double noise = std::pow(DriftOptions{}.step_m, 2) * 100.0 / 40.0;
  EXPECT_NEAR(edge.covariance(0, 0), noise, 1e-12) << "never firmer than an edge of the map";
}

// All see the same landmarks; a loop that was wrong moved the second half.
TEST(LoopGraph, NothingThatAWrongCorrectionMadeHoldsItUp) {
  Row row(6, 0.3, 0);
  for (int i = 0; i < 20; ++i) {
    std::vector<Observation> all;
    for (const KeyframeId id : row.ids) all.push_back({id, static_cast<std::uint16_t>(i)});
    test::add_landmark(row.map, {0, 0, 2}, i, all);
  }
  for (std::size_t k = 1; k < row.ids.size(); ++k)
    row.map.apply(SetOdometry{row.ids[k], {row.ids[k - 1], standing_at(0.3), 1e-6 * Matrix6d::Identity()}});
  const auto edges_off = [&row] {
    int off = 0;
    const KeyframeGraph graph = graph_of(row.map, {}, 10);
    for (const KeyframeEdge& e : graph.edges)
      off += std::abs(e.a_from_b.translation().x() - 0.3 * (e.b - e.a)) > 0.01;
    return off;
  };
  ASSERT_EQ(graph_of(row.map, {}, 10).edges.size(), 15U);
  const Se3 wrong(so3_exp({0, 1.5, 0}), {7, 0, 1});
  for (const std::size_t k : {3U, 4U, 5U})
    row.map.apply(MoveKeyframe{row.ids[k], wrong * standing_at(0.3 * static_cast<double>(k))});
  EXPECT_EQ(edges_off(), 0);
}

TEST(LoopGraph, BridgesGapsByOdometryWhereThereIsSome) {
  Row row(1, 0.3, 40);
  for (const double x : {1.0, 2.0}) {
    Keyframe k = test::keyframe_seeing(row.camera, standing_at(x), test::point_grid(3, 3, x));
    k.frame_index = static_cast<std::int64_t>(10 * x);
    row.ids.push_back(test::add_keyframe(row.map, k));
  }
  row.map.apply(SetOdometry{row.ids[1], {row.ids[0], standing_at(1.1), 1e-4 * Matrix6d::Identity()}});
  row.map.apply(SetOdometry{row.ids[2], {}});
  const KeyframeGraph graph = graph_of(row.map, {});
  ASSERT_EQ(graph.edges.size(), 2U);
  EXPECT_NEAR(graph.edges[0].a_from_b.translation().x(), 1.1, 1e-12);
  EXPECT_NEAR(graph.edges[1].a_from_b.translation().x(), 1.0, 1e-12);
  EXPECT_LT(graph.edges[0].covariance.trace(), graph.edges[1].covariance.trace());
}

TEST(LoopGraph, KeepsTheStrongestNeighboursAndATree) {
  Row row(5, 0.1, 30);
  // Everybody sees twenty landmarks: all pairs are covisible.
  for (int i = 0; i < 20; ++i) {
    Landmark landmark;
    const LandmarkId id = row.map.landmarks().next_id();
    row.map.apply(AddLandmark{id, landmark});
    for (std::size_t k = 0; k < row.ids.size(); ++k) {
      const auto& landmarks = row.map.keyframes().find(row.ids[k])->landmarks;
      for (std::size_t f = 0; f < landmarks.size(); ++f) {
        if (landmarks[f].valid()) continue;
        row.map.apply(AddObservation{id, {row.ids[k], static_cast<std::uint16_t>(f)}});
        break;
      }
    }
  }
  EXPECT_LT(graph_of(row.map, {}, 1).edges.size(), 6U);
  EXPECT_EQ(graph_of(row.map, {}, 5).edges.size(), 10U);
}

TEST(LoopGraph, DriftGrowsWithTheWay) {
  DriftOptions options;
  const Row row(21, 0.3, 40);
  const KeyframeGraph graph = graph_of(row.map, options);
  const auto near = drift_between(graph, options, row.ids[0], row.ids[5]);
  const auto far = drift_between(graph, options, row.ids[0], row.ids[20]);
  ASSERT_TRUE(near && far);
  EXPECT_NEAR(near->way_m, 1.5, 1e-9);
  EXPECT_NEAR(far->way_m, 6.0, 1e-9);
  // Along the way: 20 steps of noise, and the share of 6 m.
  const double step = options.step_m * std::sqrt(100.0 / 40.0);
  EXPECT_NEAR(far->covariance(0, 0), 20 * step * step + std::pow(options.share_of_way * 6, 2), 1e-6);
  // Across: the angle errors of each step act over what is left of the way.
  double across = 20 * step * step + std::pow(options.share_of_way * 6, 2);
  const double turn = options.step_deg * rad_per_deg * std::sqrt(100.0 / 40.0);
  for (int k = 0; k < 20; ++k) across += std::pow(turn * 0.3 * k, 2);
  EXPECT_NEAR(far->covariance(1, 1), across, 1e-6);
  EXPECT_LT(near->covariance(1, 1), far->covariance(1, 1));
}

// An office's length is 3.8 m: after 60 m of way, two like ones next to each other must not be taken for one; what
// tracking loses on that way must be given back.
TEST(LoopGraph, TheDefaultPriorPartsLikeRoomsFromDrift) {
  const Row row(201, 0.3, 100);
  const KeyframeGraph graph = graph_of(row.map, {});
  const auto drift = drift_between(graph, {}, row.ids.front(), row.ids.back());
  ASSERT_TRUE(drift);
  EXPECT_NEAR(drift->way_m, 60, 1e-9);
  const double limit = LoopCheckOptions{}.max_drift_sigmas;
  const auto sigmas = [&](double off_m, double turned_deg) {
    Vector6d off;
    off << off_m, 0, 0, 0, turned_deg * rad_per_deg, 0;
    return sigmas_of(off, drift->covariance);
  };
  EXPECT_LT(sigmas(0.01 * 60, 1.0), limit)
      << "1 % of the way: the 95th percentile of what was measured in buildings";
  EXPECT_GT(sigmas(3.8, 0), limit);
}

TEST(LoopGraph, DriftIsTheSameSeenFromEitherEnd) {
  const Row row(9, 0.3, 40);
  DriftOptions noise_only;
  noise_only.share_of_way = noise_only.share_of_turn = noise_only.turn_deg_per_m = 0;
  const KeyframeGraph graph = graph_of(row.map, noise_only);
  const auto there = drift_between(graph, noise_only, row.ids[1], row.ids[7]);
  const auto back = drift_between(graph, noise_only, row.ids[7], row.ids[1]);
  const Matrix6d turned_round = inverted_covariance(standing_at(1.8), there->covariance);
  EXPECT_LT((back->covariance - turned_round).norm(), 1e-12);
  EXPECT_EQ(drift_between(graph, {}, row.ids[1], row.ids[1])->way_m, 0);
  EXPECT_FALSE(drift_between(graph, {}, row.ids[1], KeyframeId{99, 0}).has_value());
}

}  // namespace
}  // namespace vsgraphs
