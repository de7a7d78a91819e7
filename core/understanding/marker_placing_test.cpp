#include "core/understanding/marker_placing.h"

#include <gtest/gtest.h>

#include "core/map/test_map.h"

namespace vsgraphs {
namespace {

using namespace test;

constexpr MarkerId seven{7}, eight{8};

class MarkerPlacing : public ::testing::Test {
 protected:
  MarkerPlacing() {
    for (int k = 0; k < 4; ++k)
      keyframes.push_back(add_keyframe(map, keyframe_seeing(Camera{}, standing_at(k), {})));
  }
  // A marker at `x` in the world, 2 m ahead.
  MarkerDetection at(std::size_t k, MarkerId id, double x, double size_m = 0.16) const {
    return {id, size_m, standing_at(x - static_cast<double>(k), 0, 2), 1e-4 * Matrix6d::Identity()};
  }
  void place(std::size_t k, const std::vector<MarkerDetection>& detections) {
    map.apply(place_markers(keyframes[k], detections, map.snapshot()));
  }
  double x_of(MarkerId id) const { return map.markers().at(id)->world_from_marker.translation().x(); }
  std::size_t sights_of(MarkerId id) const { return map.markers().at(id)->observations.size(); }

  Map map;
  std::vector<KeyframeId> keyframes;
};

TEST_F(MarkerPlacing, ANewMarkerStandsWhereItWasSeen) {
  place(1, {at(1, seven, 1.5), at(1, eight, 0.7)});
  EXPECT_EQ(map.markers().size(), 2U);
  EXPECT_NEAR(x_of(seven), 1.5, 1e-12);
  EXPECT_NEAR(x_of(eight), 0.7, 1e-12);
  EXPECT_EQ(map.markers().at(seven)->size_m, 0.16);
}

TEST_F(MarkerPlacing, LaterSightsAddUpAndDoNotMoveIt) {
  place(1, {at(1, seven, 1.5)});
  place(2, {at(2, seven, 1.55)});
  EXPECT_EQ(sights_of(seven), 2U);
  EXPECT_NEAR(x_of(seven), 1.5, 1e-12);
}

TEST_F(MarkerPlacing, WhatAFrameIsSaidToShowReplacesWhatItWasSaidToShow) {
  place(1, {at(1, seven, 1.5), at(1, eight, 0.7)});
  place(1, {at(1, seven, 1.6)});
  EXPECT_EQ(sights_of(seven), 1U);
  EXPECT_NEAR(x_of(seven), 1.6, 1e-12);
  EXPECT_FALSE(map.markers().contains(eight));
}

TEST_F(MarkerPlacing, AWrongFirstSightGivesWayToWhereMostSeeIt) {
  place(0, {at(0, seven, 9)});
  place(1, {at(1, seven, 1.5)});
  EXPECT_NEAR(x_of(seven), 9, 1e-12);
  place(2, {at(2, seven, 1.5)});
  EXPECT_NEAR(x_of(seven), 1.5, 1e-12);
  place(3, {at(3, seven, 1.52)});
  EXPECT_NEAR(x_of(seven), 1.5, 1e-12);
}

TEST_F(MarkerPlacing, ANumberTwiceInOneImageIsInTwoPlaces) {
  for (std::size_t k : {1U, 2U}) place(k, {at(k, seven, 1.5), at(k, seven, 4)});
  EXPECT_TRUE(map.sightings(*map.markers().at(seven)).in_two_places());
}

TEST_F(MarkerPlacing, AnotherSizeStartsAnew) {
  place(1, {at(1, seven, 1.5)});
  place(2, {at(2, seven, 1.2, 0.3)});
  EXPECT_EQ(sights_of(seven), 1U);
  EXPECT_EQ(map.markers().at(seven)->size_m, 0.3);
  EXPECT_NEAR(x_of(seven), 1.2, 1e-12);
}

TEST_F(MarkerPlacing, AKeyframeThatIsGoneSeesNothing) {
  map.apply(RemoveKeyframe{keyframes[1], keyframes[0]});
  EXPECT_TRUE(place_markers(keyframes[1], std::vector{at(1, seven, 1.5)}, map.snapshot()).operations.empty());
}

}  // namespace
}  // namespace vsgraphs
