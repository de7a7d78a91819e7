#include "core/loops/loop_closer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/loops/test_loop_world.h"
#include "core/vision/place_keeper.h"

namespace vsgraphs {
namespace {

using test::LoopWorld;
using test::LoopWorldOptions;

// 0.13 m and 2 deg over a turn.
LoopWorldOptions drifting() {
  LoopWorldOptions options;
  options.drift_per_step << 0.002, 0.001, 0.003, 0, 0.001, 0;
  return options;
}

struct Outcome {
  LoopReport report;
  std::optional<MapEdit> edit;
};

// These worlds drift faster than a camera does, so that few keyframes will do.
LoopCloserOptions expecting_much_drift() {
  LoopCloserOptions options;
  options.drift.share_of_way = 0.02;
  options.drift.turn_deg_per_m = 0.2;
  options.checks.max_drift_sigmas = 5;
  return options;
}

Outcome close_at_end(LoopWorld& world, const LoopCloserOptions& options = expecting_much_drift()) {
  LoopCloser closer(options, world.camera, world.pyramid, 1);
  Outcome outcome;
  outcome.edit = closer.close(world.ids.back(), world.map.snapshot(), world.places, outcome.report, nullptr);
  return outcome;
}

TEST(LoopCloser, ClosesALoopAndTakesTheDriftBack) {
  LoopWorld world(drifting());
  const int last = static_cast<int>(world.ids.size()) - 1;
  const double before = world.error_m(world.map, last);
  EXPECT_GT(before, 0.1);
  const Outcome outcome = close_at_end(world);
  ASSERT_EQ(outcome.report.verdict, LoopVerdict::closed) << to_string(outcome.report.verdict);
  EXPECT_NEAR(outcome.report.off_m, before, 0.03);
  ASSERT_TRUE(outcome.edit.has_value());
  const std::uint32_t landmarks_before = world.map.landmarks().size();
  world.map.apply(*outcome.edit);
  EXPECT_LT(world.error_m(world.map, last), 0.25 * before) << "the start had drifted a little by itself";
  EXPECT_EQ(world.error_m(world.map, 0), 0);
  EXPECT_LT(world.map.landmarks().size() + 200, landmarks_before) << "what was mapped twice is one";
  int shared = 0;
  for (const auto& [id, count] : world.map.covisible(world.ids.back(), 15))
    shared += id.index < 5 ? count : 0;
  EXPECT_GT(shared, 300) << "both ends see the same landmarks now";
}

TEST(LoopCloser, SameMapGivesTheSameEdit) {
  LoopWorld world(drifting());
  const Outcome a = close_at_end(world), b = close_at_end(world);
  ASSERT_TRUE(a.edit && b.edit);
  EXPECT_EQ(a.edit->hash(), b.edit->hash());
}

TEST(LoopCloser, FindsNothingInAFirstTurn) {
  LoopWorldOptions options = drifting();
  options.keyframes = 20;
  LoopWorld world(options);
  const Outcome outcome = close_at_end(world);
  EXPECT_FALSE(outcome.edit.has_value());
  EXPECT_LT(outcome.report.verdict, LoopVerdict::tilted);
}

TEST(LoopCloser, WithoutDriftMergesButMovesNothing) {
  LoopWorldOptions options;
  LoopWorld world(options);
  const Outcome outcome = close_at_end(world);
  ASSERT_EQ(outcome.report.verdict, LoopVerdict::joined);
  for (const EditOperation& operation : outcome.edit->operations)
    EXPECT_FALSE(std::holds_alternative<MoveKeyframe>(operation));
}

TEST(LoopCloser, PausesAfterALoop) {
  LoopWorld world(drifting());
  LoopCloser closer(expecting_much_drift(), world.camera, world.pyramid, 1);
  LoopReport report;
  EXPECT_TRUE(closer.close(world.ids[32], world.map.snapshot(), world.places, report, nullptr));
  EXPECT_FALSE(closer.close(world.ids[33], world.map.snapshot(), world.places, report, nullptr));
  EXPECT_EQ(report.verdict, LoopVerdict::none_similar);
}

TEST(LoopCloser, AsksTheNeighbours) {
  // Half way round, a look of the start appears in one keyframe: a mirror, or the same poster hung twice.
  LoopWorldOptions options;
  options.keyframes = 16;
  options.ghost = 0;
  LoopWorld world(options);
  LoopCloserOptions believes_drift = expecting_much_drift();
  believes_drift.checks.max_drift_sigmas = 100;
  EXPECT_EQ(close_at_end(world, believes_drift).report.verdict, LoopVerdict::unsupported);
  believes_drift.alignment.supporters = 0;
  EXPECT_EQ(close_at_end(world, believes_drift).report.verdict, LoopVerdict::closed);
}

// Each check refuses a loop that everything else would let through.
struct Refusal {
  const char* name;
  LoopVerdict verdict;
  void (*spoil)(LoopWorldOptions&);
  void (*disarm)(LoopCloserOptions&);
};

class LoopCloserRefusal : public ::testing::TestWithParam<Refusal> {};

TEST_P(LoopCloserRefusal, ComesFromItsCheckAlone) {
  LoopWorldOptions options = drifting();
  GetParam().spoil(options);
  LoopWorld world(options);
  world.map.apply(vsgraphs::SetUp{{0, -1, 0}});
  const Outcome refused = close_at_end(world);
  EXPECT_EQ(refused.report.verdict, GetParam().verdict) << to_string(refused.report.verdict);
  EXPECT_FALSE(refused.edit.has_value());
  LoopCloserOptions disarmed = expecting_much_drift();
  GetParam().disarm(disarmed);
  const Outcome let_through = close_at_end(world, disarmed);
  EXPECT_EQ(let_through.report.verdict, LoopVerdict::closed) << to_string(let_through.report.verdict);
}

INSTANTIATE_TEST_SUITE_P(
    Checks, LoopCloserRefusal,
    ::testing::Values(Refusal{"Tilted", LoopVerdict::tilted,
                              [](LoopWorldOptions& w) { w.drift_per_step[5] = 0.0045; },
                              [](LoopCloserOptions& o) { o.checks.max_tilt_deg = 45; }},
                      Refusal{"WallTurned", LoopVerdict::surfaces_disagree,
                              [](LoopWorldOptions& w) {
                                w.second_patch_turn_rad = 0.35;
                                w.grids = false;
                              },
                              [](LoopCloserOptions& o) { o.checks.max_disagreeing_share = 1; }},
                      Refusal{"WallNearer", LoopVerdict::surfaces_disagree,
                              [](LoopWorldOptions& w) {
                                w.second_half_width_m = 2.75;
                                w.grids = false;
                              },
                              [](LoopCloserOptions& o) { o.checks.max_disagreeing_share = 1; }},
                      Refusal{"ThroughWalls", LoopVerdict::through_walls,
                              [](LoopWorldOptions& w) {
                                w.second_half_width_m = 2;
                                w.patches = false;
                              },
                              [](LoopCloserOptions& o) { o.checks.max_seen_through_share = 1; }},
                      Refusal{"BeyondDrift", LoopVerdict::beyond_drift,
                              [](LoopWorldOptions& w) { w.second_room_at = {9, 0, 0}; },
                              [](LoopCloserOptions& o) { o.checks.max_drift_sigmas = 100; }}),
    [](const auto& refusal) { return refusal.param.name; });

TEST(FollowTheMap, AddsNewKeyframesAndRemovesCulledOnes) {
  LoopWorld world(drifting());
  PlaceIndex places;
  complete(world.map, places);
  EXPECT_EQ(places.size(), 34);
  world.map.apply(RemoveKeyframe{world.ids[7], world.ids[6]});
  complete(world.map, places);
  EXPECT_EQ(places.size(), 33);
  EXPECT_FALSE(places.contains(world.ids[7]));
}

}  // namespace
}  // namespace vsgraphs
