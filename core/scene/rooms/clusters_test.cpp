#include "core/scene/rooms/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/scene/rooms/basins.h"
#include "core/scene/rooms/clearance.h"

namespace vsgraphs {
namespace {

// A storey drawn in characters, one per 0.1 m, the first row at the top: '.' open, '#' wall, 'x' furniture, '+' furniture
// with free space above it up to the ceiling, ' ' unknown, ':' open below a lintel.
LevelMap drawn(const std::vector<std::string>& rows) {
  LevelMap map;
  map.frame = {{0, 0}, 0.1, static_cast<int>(rows[0].size()), static_cast<int>(rows.size())};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    for (const char c : *row) {
      map.cells.push_back(c == '.' || c == ':' ? CellState::open
                          : c == ' '           ? CellState::unknown
                                               : CellState::blocked);
      map.walls.push_back(c == '#');
      ColumnCounts counts;
      if (c == ':') counts.lintel_occupied = 2;
      if (c == '.' || c == '+') counts.lintel_free = 2;
      map.columns.push_back(counts);
    }
  return map;
}

// Two rooms 3 m wide and 2.6 m deep; `between` draws the 27 rows of the two columns between them.
std::vector<std::string> two_halves(const std::string& between) {
  std::vector<std::string> rows{std::string(66, '#')};
  for (std::size_t r = 0; r < 26; ++r)
    rows.push_back("##" + std::string(30, '.') + std::string(2, between[r]) + std::string(30, '.') + "##");
  rows.push_back(std::string(66, '#'));
  return rows;
}

Clusters clusters_of(const std::vector<std::string>& rows) {
  return find_clusters(drawn(rows), {}, {}, {}, {});
}

TEST(Clusters, ADoorwayDividesAWiderPassageDoesNot) {
  const auto gap = [](int cells, char c) {
    std::string between(26, '#');
    std::fill_n(between.begin() + 8, cells, c);
    return between;
  };
  for (const int cells : {7, 9, 12}) {
    const Clusters found = clusters_of(two_halves(gap(cells, ':')));
    ASSERT_EQ(found.clusters.size(), 2u) << cells;
    ASSERT_EQ(found.openings.size(), 1u) << cells;
    const WallOpening& opening = found.openings[0].opening;
    EXPECT_NEAR(opening.width_m, 0.1 * cells, 0.11);
    EXPECT_NEAR((opening.center - Eigen::Vector2d(3.3, 2.7 - 0.8 - 0.05 * cells)).norm(), 0, 0.12);
    EXPECT_GT(std::abs(opening.normal.x()), 0.95);
    EXPECT_NE(found.openings[0].clusters[0], found.openings[0].clusters[1]);
    for (const Cluster& cluster : found.clusters) EXPECT_NEAR(cluster.area_m2, 7.8, 0.5);
  }
  EXPECT_EQ(clusters_of(two_halves(gap(18, ':'))).clusters.size(), 1u);
}

TEST(Clusters, ACrackInAWallDividesAndIsNoOpening) {
  // A wall not seen over a width nobody walks through.
  std::string between(26, '#');
  std::fill_n(between.begin() + 8, 3, ':');
  const Clusters found = clusters_of(two_halves(between));
  EXPECT_EQ(found.clusters.size(), 2u);
  EXPECT_TRUE(found.openings.empty());
}

TEST(Clusters, ANarrowPlaceUnderFreeSpaceIsFurniture) {
  std::string between(26, '+');
  std::fill_n(between.begin() + 8, 9, '.');
  const Clusters found = clusters_of(two_halves(between));
  EXPECT_EQ(found.clusters.size(), 1u);
  EXPECT_TRUE(found.openings.empty());
}

TEST(Clusters, ThingsThatStandFreeDoNotDivide) {
  // A screen across the room that leaves a door's width at either end.
  std::string between(26, '.');
  std::fill_n(between.begin() + 7, 12, 'x');
  EXPECT_EQ(clusters_of(two_halves(between)).clusters.size(), 1u);
}

TEST(Clusters, SmallSpacesAreNone) {
  std::vector<std::string> rows = two_halves(std::string(26, '#'));
  EXPECT_EQ(clusters_of(rows).clusters.size(), 2u);
  for (std::string& row : rows) row = row.substr(0, 40) + "##";  // leaves 0.6 m of the second room
  for (std::size_t r = 14; r < rows.size(); ++r) rows[r] = std::string(42, '#');
  EXPECT_EQ(clusters_of(rows).clusters.size(), 1u);
}

TEST(Clusters, KnowWhereTheCameraHasBeen) {
  const std::vector<Eigen::Vector2d> cameras{{1, 1}};
  const Clusters found = find_clusters(drawn(two_halves(std::string(26, '#'))), {}, cameras, {}, {});
  ASSERT_EQ(found.clusters.size(), 2u);
  for (const Cluster& cluster : found.clusters) EXPECT_EQ(cluster.visited, cluster.centroid.x() < 3.3);
}

TEST(Basins, PeaksAreJoinedUnlessWhatLiesBetweenDivides) {
  const LevelMap map = drawn(two_halves("########.........#########"));
  GridValues<char> open;
  for (const CellState state : map.cells) open.push_back(state == CellState::open);
  const GridValues<float> clearance = clearance_field(map.frame, open);
  std::vector<Narrowing> seen;
  const auto ask = [&](bool answer) {
    return find_basins(map.frame, clearance, 0.15, [&](const Narrowing& n) {
      seen.push_back(n);
      return answer;
    });
  };
  EXPECT_EQ(ask(false).count, 1);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_NEAR(seen[0].gap.width_m, 0.9, 0.1);
  EXPECT_NEAR(seen[0].clearance_m, 0.5, 0.1);
  EXPECT_NEAR(seen[0].lower_peak_m, 1.35, 0.1);
  const Basins divided = ask(true);
  EXPECT_EQ(divided.openings.size(), 1u);
  const auto label = [&](double x, double y) {
    return divided.labels[static_cast<std::size_t>(map.frame.index_at({x, y}))];
  };
  EXPECT_EQ(label(0.5, 0.5), label(2.5, 2.0));
  EXPECT_EQ(label(4.5, 0.5), label(6.0, 2.0));
  EXPECT_NE(label(0.5, 0.5), label(6.0, 2.0));
  EXPECT_EQ(label(0.05, 0.05), -1);
}

}  // namespace
}  // namespace vsgraphs
