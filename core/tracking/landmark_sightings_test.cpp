#include "core/tracking/landmark_sightings.h"

#include <gtest/gtest.h>

namespace vsgraphs {
namespace {

FrameMatches matching(const std::vector<LandmarkId>& landmarks) {
  FrameMatches matches;
  matches.reset(static_cast<int>(landmarks.size()));
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    matches.add({static_cast<int>(i), landmarks[i], Eigen::Vector3d::Zero()});
  return matches;
}

constexpr LandmarkId a{3, 0}, b{5, 0}, c{9, 1};

TEST(LandmarkSightings, CountsWhatWasFoundAndWhatShouldHaveBeen) {
  LandmarkSightings sightings;
  sightings.count(matching({c, a, {}}), {a, b, c}, 2);
  sightings.count(matching({c, {}}), {b, c}, 2);
  const std::vector<Sighting> all = sightings.take();
  ASSERT_EQ(all.size(), 3U) << "bare depth readings are no landmarks";
  EXPECT_EQ(all[0].landmark, a);
  EXPECT_EQ(all[1].landmark, b);
  EXPECT_EQ(all[2].landmark, c);
  EXPECT_EQ(all[0].found, 1U);
  EXPECT_EQ(all[0].visible, 1U);
  EXPECT_EQ(all[1].found, 0U);
  EXPECT_EQ(all[1].visible, 2U);
  EXPECT_EQ(all[2].found, 2U);
  EXPECT_EQ(all[2].visible, 2U);
}

TEST(LandmarkSightings, AFrameThatShowsNothingSaysNothingAgainstLandmarks) {
  LandmarkSightings sightings;
  sightings.count(matching({a}), {a, b}, 2);
  const std::vector<Sighting> all = sightings.take();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].found, 1U);
  EXPECT_EQ(all[0].visible, 0U);
}

TEST(LandmarkSightings, BeginsAnewWhenTakenOrCleared) {
  LandmarkSightings sightings;
  sightings.count(matching({a}), {a}, 0);
  EXPECT_EQ(sightings.take().size(), 1U);
  EXPECT_TRUE(sightings.take().empty());
  sightings.count(matching({a}), {a}, 0);
  sightings.clear();
  EXPECT_TRUE(sightings.take().empty());
}

}  // namespace
}  // namespace vsgraphs
