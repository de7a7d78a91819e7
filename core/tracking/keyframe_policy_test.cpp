#include "core/tracking/keyframe_policy.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

// A camera that moves and sees all it should: no keyframe is due.
KeyframeEvidence content() {
  KeyframeEvidence e;
  e.tracked = e.tracked_close = 300;
  e.reference_landmarks = 300;
  e.seconds_since_last = 0.1;
  e.translation_m = 0.05;
  return e;
}

template <typename Change>
bool wanted(Change&& change) {
  KeyframeEvidence e = content();
  change(e);
  return keyframe_wanted({}, e);
}

TEST(KeyframePolicy, NotWhileTheMapIsSeenWell) { EXPECT_FALSE(keyframe_wanted({}, content())); }

TEST(KeyframePolicy, WhenTheReferencesLandmarksRunOut) {
  EXPECT_FALSE(wanted([](auto& e) { e.tracked = 255; }));
  EXPECT_TRUE(wanted([](auto& e) { e.tracked = 254; }));
  EXPECT_TRUE(wanted([](auto& e) { e.reference_landmarks = 0; }));
}

TEST(KeyframePolicy, WhenDepthSeesMuchThatTheMapLacks) {
  EXPECT_TRUE(wanted([](auto& e) { e.tracked_close = 99, e.untracked_close = 71; }));
  EXPECT_FALSE(wanted([](auto& e) { e.tracked_close = 100, e.untracked_close = 71; }));
  EXPECT_FALSE(wanted([](auto& e) { e.tracked_close = 99, e.untracked_close = 70; }));
}

TEST(KeyframePolicy, WhenTheLastIsLongAgo) {
  EXPECT_TRUE(wanted([](auto& e) { e.seconds_since_last = 1.0; }));
  EXPECT_FALSE(wanted([](auto& e) { e.seconds_since_last = 0.99; }));
}

TEST(KeyframePolicy, NeverWhileTheCameraStands) {
  const auto still = [](auto& e) {
    e.tracked = 10;
    e.seconds_since_last = 100;
    e.translation_m = 0.019;
    e.rotation_rad = 0.034;
  };
  EXPECT_FALSE(wanted(still));
  EXPECT_TRUE(wanted([&](auto& e) { still(e), e.translation_m = 0.02; }));
  EXPECT_TRUE(wanted([&](auto& e) { still(e), e.rotation_rad = 0.035; }));
}

TEST(KeyframePolicy, ABusyMapperIsInterruptedOnlyByNeed) {
  const auto thinning = [](auto& e) { e.tracked = 200, e.backlog = 1; };
  EXPECT_FALSE(wanted(thinning));
  EXPECT_TRUE(wanted([&](auto& e) { thinning(e), e.tracked = 127; })) << "less than half the usual share";
  EXPECT_TRUE(wanted([](auto& e) { e.tracked = 49, e.reference_landmarks = 49, e.backlog = 2; }));
  EXPECT_FALSE(wanted([](auto& e) { e.tracked = 10, e.backlog = 3; })) << "too busy for any";
}

TEST(KeyframePolicy, WhereSurfacesHoldThePoseDistanceDecides) {
  const auto held = [](auto& e) { e.held_by_surfaces = true, e.tracked = 0, e.seconds_since_last = 100; };
  EXPECT_FALSE(wanted([&](auto& e) { held(e), e.translation_m = 0.11, e.rotation_rad = 0.14; }));
  EXPECT_TRUE(wanted([&](auto& e) { held(e), e.translation_m = 0.12; }));
  EXPECT_TRUE(wanted([&](auto& e) { held(e), e.rotation_rad = 0.15; }));
  EXPECT_FALSE(wanted([&](auto& e) { held(e), e.translation_m = 0.12, e.backlog = 3; }));
}

}  // namespace
}  // namespace vsgraphs
