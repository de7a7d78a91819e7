#include "core/vision/spread.h"

#include <gtest/gtest.h>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

Corner corner(int x, int y, int score) {
  return {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), static_cast<std::uint8_t>(score)};
}

// Nine tenths of the corners crowd into one ninth of the image, and the strongest do.
std::vector<Corner> crowded(int count) {
  Rng rng(1, "crowded", 0);
  std::vector<Corner> corners;
  for (int i = 0; i < count; ++i) {
    const int extent = i % 10 == 0 ? 300 : 100;
    corners.push_back(corner(static_cast<int>(rng.index(extent)), static_cast<int>(rng.index(extent)),
                             30 + static_cast<int>(rng.index(i % 10 == 0 ? 50 : 200))));
  }
  return corners;
}

TEST(CornerSpread, GivesExactlyTheWantedNumberSpreadOut) {
  const std::vector<Corner> corners = crowded(3000);
  CornerSpread spread;
  std::vector<ChosenCorner> chosen;
  for (int wanted : {1, 50, 200, 1000}) {
    spread.choose(corners, 300, 300, wanted, 20, chosen);
    EXPECT_EQ(static_cast<int>(chosen.size()), wanted);
  }
  spread.choose(corners, 300, 300, 100, 20, chosen);
  int outside = 0;
  for (const ChosenCorner& c : chosen) outside += c.corner.x >= 100 || c.corner.y >= 100;
  EXPECT_GT(outside, 60) << "the crowd fills a ninth of the image and may not take much more of the features";
}

TEST(CornerSpread, TakesTheBestOfEveryCellFirst) {
  CornerSpread spread;
  std::vector<ChosenCorner> chosen;
  const std::vector<Corner> corners{corner(10, 10, 50), corner(12, 10, 60), corner(290, 290, 25),
                                    corner(14, 10, 55)};
  spread.choose(corners, 300, 300, 3, 20, chosen);  // a single cell
  ASSERT_EQ(chosen.size(), 3u);
  EXPECT_EQ(chosen[2].corner.score, 50) << "three best, the last one in its round";
  spread.choose(corners, 300, 300, 40, 20, chosen);
  ASSERT_EQ(chosen.size(), 4u);
  EXPECT_EQ(chosen[0].corner.score, 60);
  EXPECT_EQ(chosen[1].corner.score, 55);
  EXPECT_EQ(chosen[1].rank, 1);
  EXPECT_EQ(chosen[3].corner.score, 25) << "by cell, then by rank";
  EXPECT_EQ(chosen[3].rank, 0);
}

TEST(CornerSpread, WeakCornersOnlyWhereNoStrongOneIs) {
  CornerSpread spread;
  std::vector<ChosenCorner> chosen;
  spread.choose({corner(10, 10, 50), corner(20, 10, 10), corner(290, 290, 9)}, 300, 300, 40, 20, chosen);
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].corner.score, 50);
  EXPECT_EQ(chosen[1].corner.score, 9);
}

TEST(CornerSpread, HandlesNothing) {
  CornerSpread spread;
  std::vector<ChosenCorner> chosen{{}};
  spread.choose({}, 100, 100, 10, 20, chosen);
  EXPECT_TRUE(chosen.empty());
  spread.choose({corner(5, 5, 50)}, 100, 100, 0, 20, chosen);
  EXPECT_TRUE(chosen.empty());
}

}  // namespace
}  // namespace vsgraphs
