#include "core/mapping/culling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

class ProbationTest : public ::testing::Test {
 protected:
  ProbationTest() {
    for (int k = 0; k < 3; ++k)
      keyframes_.push_back(add_keyframe(map_, keyframe_seeing(camera_, standing_at(0.1 * k), points_)));
  }
  // A landmark seen by that many keyframes, and found in so many of the frames that should show it.
  LandmarkId add(int observers, std::uint32_t visible, std::uint32_t found) {
    std::vector<Observation> observations;
    for (int k = 0; k < observers; ++k)
      observations.push_back({keyframes_[static_cast<std::size_t>(k)], next_feature_});
    const LandmarkId id = add_landmark(map_, points_[next_feature_], next_feature_, observations);
    map_.apply(CountSightings{id, visible, found});
    ++next_feature_;
    return id;
  }
  // Is it in the map after being judged so many keyframes after its birth?
  bool survives(LandmarkId id, int age) {
    Probation probation;
    probation.admit({id}, 10);
    Draft draft(map_.snapshot());
    probation.judge(options_, 10 + age, draft);
    return draft.map().landmarks().contains(id);
  }

  Camera camera_;
  CullingOptions options_;
  Points points_ = point_grid(5, 4);
  Map map_;
  std::vector<KeyframeId> keyframes_;
  std::uint16_t next_feature_ = 0;
};

TEST_F(ProbationTest, SeldomFoundIsRemoved) {
  EXPECT_FALSE(survives(add(3, 100, 24), 0));
  EXPECT_TRUE(survives(add(3, 100, 25), 0));
}

TEST_F(ProbationTest, ThinlyObservedIsRemovedWhenItsTimeIsUp) {
  const LandmarkId once = add(1, 1, 1), twice = add(2, 1, 1);
  EXPECT_TRUE(survives(once, 0));
  EXPECT_TRUE(survives(once, 1));
  EXPECT_FALSE(survives(once, 2));
  EXPECT_TRUE(survives(twice, 2));
  EXPECT_TRUE(survives(twice, 3));
}

TEST_F(ProbationTest, SeenByNobodyIsRemovedAtOnce) { EXPECT_FALSE(survives(add(0, 1, 1), 0)); }

TEST_F(ProbationTest, WhoPassedIsNotJudgedAgain) {
  const LandmarkId id = add(3, 1, 1);
  Probation probation;
  probation.admit({id}, 10);
  Draft draft(map_.snapshot());
  probation.judge(options_, 12, draft);
  draft.record(CountSightings{id, 1000, 0});
  probation.judge(options_, 12, draft);
  EXPECT_FALSE(draft.map().landmarks().contains(id)) << "still young at an age of 2";

  Draft other(map_.snapshot());
  Probation long_ago;
  long_ago.admit({id}, 10);
  long_ago.judge(options_, 13, other);
  other.record(CountSightings{id, 1000, 0});
  long_ago.judge(options_, 14, other);
  EXPECT_TRUE(other.map().landmarks().contains(id)) << "released at an age of 3";
}

TEST_F(ProbationTest, GoesOnWhereItWasWhenItsMapIsTakenUpAgain) {
  const LandmarkId id = add(1, 1, 1);
  Probation away, here;
  away.admit({id}, 10);
  here.take_up(away, 11, 500);  // one keyframe old by then
  Draft draft(map_.snapshot());
  here.judge(options_, 500, draft);
  EXPECT_TRUE(draft.map().landmarks().contains(id)) << "still young";
  here.judge(options_, 501, draft);
  EXPECT_FALSE(draft.map().landmarks().contains(id)) << "thinly observed when its time is up";
}

TEST_F(ProbationTest, VanishedLandmarksAreForgotten) {
  const LandmarkId merged = add(3, 1, 1), into = add(3, 1, 1);
  Probation probation;
  probation.admit({merged}, 10);
  map_.apply(MergeLandmark{merged, into});
  Draft draft(map_.snapshot());
  probation.judge(options_, 11, draft);
  EXPECT_TRUE(draft.take().operations.empty());
}

// Five keyframes side by side see the same twenty points.
class KeyframeCullingTest : public ::testing::Test {
 protected:
  KeyframeCullingTest() {
    for (int k = 0; k < 5; ++k) add(keyframe_seeing(camera_, standing_at(0.1 * k), points_));
  }
  void add(const Keyframe& keyframe) { keyframes_.push_back(add_keyframe(map_, keyframe)); }
  void observe_all() { landmarks_ = add_landmarks(map_, points_, keyframes_); }
  void unobserve(int keyframe, int count) {
    for (int i = 0; i < count; ++i)
      map_.apply(RemoveObservation{landmarks_[static_cast<std::size_t>(i)], at(keyframe)});
  }
  KeyframeId at(int k) const { return keyframes_[static_cast<std::size_t>(k)]; }
  // Which keyframes are gone when those of the given numbers are candidates, by number.
  std::vector<int> culled(const std::vector<int>& candidates) {
    std::vector<KeyframeId> ids;
    for (const int k : candidates) ids.push_back(at(k));
    Draft draft(map_.snapshot());
    cull_keyframes(options_, ids, draft);
    std::vector<int> gone;
    for (int k = 0; k < static_cast<int>(keyframes_.size()); ++k)
      if (!draft.map().keyframes().contains(at(k))) gone.push_back(k);
    return gone;
  }

  Camera camera_;
  CullingOptions options_;
  Points points_ = point_grid(5, 4);
  Map map_;
  std::vector<KeyframeId> keyframes_;
  std::vector<LandmarkId> landmarks_;
};

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST_F(KeyframeCullingTest, RedundantIsRemovedUntilWitnessesRunShort) {
  observe_all();
  EXPECT_THAT(culled({2}), ElementsAre(2));
  // Four are left after the first: three witnesses for the second. Then two: too few.
  EXPECT_THAT(culled({1, 2, 3, 4}), ElementsAre(1, 2));
}

TEST_F(KeyframeCullingTest, TheFirstKeyframeStays) {
  observe_all();
  EXPECT_THAT(culled({0}), IsEmpty());
}

TEST_F(KeyframeCullingTest, KeyframesHeldByALinkStay) {
  Keyframe linked = keyframe_seeing(camera_, standing_at(0.5), points_);
  linked.tracked_link = TrackedLink{at(0), standing_at(0.5), Matrix6d::Identity()};
  add(linked);
  observe_all();
  EXPECT_THAT(culled({5}), IsEmpty());
  EXPECT_THAT(culled({4}), ElementsAre(4));
}

TEST_F(KeyframeCullingTest, WhoShowsSomethingOfItsOwnStays) {
  observe_all();
  // Two of twenty points have two witnesses only: 18 of 20 is not more than the share of 0.9.
  unobserve(0, 2);
  unobserve(1, 2);
  EXPECT_THAT(culled({4}), IsEmpty());
  options_.redundant_share = 0.85;
  EXPECT_THAT(culled({4}), ElementsAre(4));
}

TEST_F(KeyframeCullingTest, CoarserSightsAreNoWitnesses) {
  // Two of the others see everything two levels coarser.
  for (int k = 5; k < 7; ++k) {
    add(with_features_changed(keyframe_seeing(camera_, standing_at(0.1 * k), points_), camera_, [](auto& f) {
      for (Feature& feature : f) feature.level = 2;
    }));
  }
  keyframes_.erase(keyframes_.begin() + 1, keyframes_.begin() + 3);  // first, 3, 4 and the two coarse ones
  observe_all();
  EXPECT_THAT(culled({1}), IsEmpty());       // two fine witnesses
  EXPECT_THAT(culled({3}), ElementsAre(3));  // a coarse one has four
}

TEST_F(KeyframeCullingTest, PointsWithoutDepthHaveNoSay) {
  Keyframe keyframe = keyframe_seeing(camera_, standing_at(0.5), points_);
  add(with_features_changed(keyframe, camera_, [](auto& f) {
    for (std::size_t i = 0; i < 5; ++i) f[i].depth_m = 0;
  }));
  observe_all();
  for (int k = 0; k < 5; ++k) unobserve(k, 5);  // the five without depth are its own
  EXPECT_THAT(culled({5}), ElementsAre(5));
}

TEST_F(KeyframeCullingTest, FramesOfARemovedKeyframeHangOnItsClosestNeighbour) {
  options_.redundant_witnesses = 1;
  observe_all();
  unobserve(0, 10);
  unobserve(1, 5);
  Draft draft(map_.snapshot());
  cull_keyframes(options_, {at(3)}, draft);
  EXPECT_EQ(draft.map().reanchor({at(3), Se3{}})->keyframe, at(2));
}

// The fifth one stands 0.4 m from the first.
class RevisitCullingTest : public KeyframeCullingTest {
 protected:
  RevisitCullingTest() {
    options_.revisit_gap_keyframes = 4;
    options_.revisit_m = 0.45;
  }
  // A plane that keyframes of these numbers see.
  PlaneId add_plane(const std::vector<int>& seen_by) {
    const PlaneId id = map_.planes().next_id();
    map_.apply(AddPlane{id, MappedPlane{}});
    for (const int k : seen_by) {
      auto surfaces = std::make_shared<KeyframeSurfaces>();
      surfaces->patches.resize(1);
      if (!map_.keyframes().find(at(k))->patches) map_.apply(SetPatches{at(k), surfaces});
      map_.apply(AddPlaneObservation{id, {at(k), 0}});
    }
    return id;
  }
  Map after_culling(int k) {
    Draft draft(map_.snapshot());
    cull_keyframes(options_, {at(k)}, draft);
    EXPECT_FALSE(draft.map().keyframes().contains(at(k)));
    return draft.map();
  }
};

TEST_F(RevisitCullingTest, AKeyframeMadeByComingBackGoesSooner) {
  observe_all();
  unobserve(1, 6);
  unobserve(2, 6);  // 14 of the last one's 20 landmarks have three other witnesses
  EXPECT_THAT(culled({4}), testing::ElementsAre(4));
  options_.revisit_share = 0.75;
  EXPECT_THAT(culled({4}), testing::IsEmpty());
  options_.revisit_share = 0.6;
  options_.revisit_m = 0.35;
  EXPECT_THAT(culled({4}), testing::IsEmpty()) << "nobody stood near";
  options_.revisit_m = 0.45;
  options_.revisit_gap_keyframes = 5;
  EXPECT_THAT(culled({4}), testing::IsEmpty()) << "that was a moment ago";
}

TEST_F(RevisitCullingTest, WhereOnlyRecentOnesSeeTheSameNobodyCameBack) {
  observe_all();
  unobserve(1, 3);  // 17 of 20 have enough witnesses
  unobserve(0, 4);  // 16 of them one that is old
  EXPECT_THAT(culled({4}), testing::ElementsAre(4));
  for (int i = 4; i < 10; ++i) map_.apply(RemoveObservation{landmarks_[static_cast<std::size_t>(i)], at(0)});
  EXPECT_THAT(culled({4}), testing::IsEmpty());
}

TEST_F(RevisitCullingTest, OneHeldByATrackedLinkGoesOnlyWhereTheCameraCameBack) {
  Keyframe linked = keyframe_seeing(camera_, standing_at(0.4), points_);
  linked.tracked_link = TrackedLink{at(4), standing_at(0), Matrix6d::Identity()};
  add(linked);
  Keyframe next = linked;
  next.world_from_camera = standing_at(0.9);
  next.tracked_link->to = at(5);
  next.tracked_link->to_from_camera = standing_at(0.5);
  add(next);
  EXPECT_THAT(culled({6}), testing::IsEmpty()) << "new ground";
  ASSERT_THAT(culled({5}), testing::ElementsAre(5));
  const Map after = after_culling(5);
  EXPECT_NEAR(after.resolve({at(5), Se3{}})->translation().x(), 0.4, 1e-12);
  EXPECT_EQ(after.reanchor({at(5), Se3{}})->keyframe, at(4)) << "tracking measured that step";
  const auto link = after.reanchor({at(5), next.tracked_link->to_from_camera});
  ASSERT_TRUE(link) << "the next one's link holds on to a living keyframe";
  EXPECT_TRUE(after.keyframes().contains(link->keyframe));
  EXPECT_NEAR(after.resolve(*link)->translation().x(), 0.9, 1e-12);
}

TEST_F(RevisitCullingTest, WhatEnoughOthersSeeOfPlanesIsForgotten) {
  observe_all();
  const PlaneId plane = add_plane({0, 1, 2, 4});
  const Map after = after_culling(4);
  EXPECT_EQ(after.planes().find(plane)->observations.size(), 3U);
  ASSERT_NE(after.retired_keyframes().find(at(4)), nullptr);
  EXPECT_EQ(after.retired_keyframes().find(at(4))->patches, nullptr);
}

TEST_F(RevisitCullingTest, WhatRetiredOnesSawOfPlanesCounts) {
  for (int k = 5; k < 7; ++k) add(keyframe_seeing(camera_, standing_at(0.1 * k), points_));
  observe_all();
  const PlaneId plane = add_plane({0, 1, 2, 4});
  for (const int k : {1, 2}) map_.apply(RemoveKeyframe{at(k), at(0)});
  const Map after = after_culling(4);
  EXPECT_EQ(after.planes().find(plane)->observations.size(), 3U);
  EXPECT_EQ(after.retired_keyframes().find(at(4))->patches, nullptr);
}

TEST_F(RevisitCullingTest, OneOtherKeyframeWithManyPatchesIsOneWitness) {
  observe_all();
  const PlaneId plane = add_plane({4});
  auto surfaces = std::make_shared<KeyframeSurfaces>();
  surfaces->patches.resize(3);
  map_.apply(SetPatches{at(0), surfaces});
  for (std::uint16_t patch = 0; patch < 3; ++patch) map_.apply(AddPlaneObservation{plane, {at(0), patch}});
  EXPECT_EQ(after_culling(4).planes().find(plane)->observations.size(), 4U);
}

TEST_F(RevisitCullingTest, NoKeyframeIsLeftHangingOnItself) {
  // The keyframe that goes shares most with one whose link leads to it.
  Keyframe next = keyframe_seeing(camera_, standing_at(0.45), points_);
  next.tracked_link = TrackedLink{at(4), standing_at(0.05), Matrix6d::Identity()};
  add(next);
  observe_all();
  for (int k = 0; k < 4; ++k) unobserve(k, 1);
  const Map after = after_culling(4);
  const auto link = after.living_link(at(5));
  ASSERT_TRUE(link);
  EXPECT_NE(link->to, at(5));
  EXPECT_NEAR(after.resolve({link->to, link->to_from_camera})->translation().x(), 0.45, 1e-12);
  EXPECT_DOUBLE_EQ(link->information(0, 0), 0.5) << "two steps";
}

TEST_F(RevisitCullingTest, WhatFewSeeOfPlanesStays) {
  observe_all();
  const PlaneId common = add_plane({0, 1, 2, 4}), rare = add_plane({0, 4});
  const Map after = after_culling(4);
  EXPECT_EQ(after.planes().find(common)->observations.size(), 3U);
  EXPECT_EQ(after.planes().find(rare)->observations.size(), 2U);
  EXPECT_NE(after.retired_keyframes().find(at(4))->patches, nullptr);
}

}  // namespace
}  // namespace vsgraphs
