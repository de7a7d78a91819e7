#include "core/vision/place_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/rng.h"

namespace vsgraphs {
namespace {

Descriptor look(std::uint64_t name) {
  Rng rng(1, "look", name);
  Descriptor d;
  for (std::uint64_t& word : d.words) word = rng.next();
  return d;
}

struct View {
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;

  // Shows look `name`, turned by `angle_rad`, as view number `noise` sees it: one bit in 16 flips, so that two views
  // differ in one of eight; noise 0 is exact.
  View& show(std::uint64_t name, std::uint64_t noise = 0, float angle_rad = 0) {
    Rng rng(noise, "flips", name);
    Descriptor d = look(name);
    for (std::uint64_t& word : d.words)
      word ^= noise == 0 ? 0 : rng.next() & rng.next() & rng.next() & rng.next();
    Feature feature;
    feature.angle_rad = angle_rad;
    features.push_back(feature);
    descriptors.push_back(d);
    return *this;
  }
  View& show_range(std::uint64_t first, std::uint64_t count, std::uint64_t noise = 0, float angle_rad = 0) {
    for (std::uint64_t i = 0; i < count; ++i) show(first + i, noise, angle_rad);
    return *this;
  }
  FeatureSet set() const { return {features, descriptors, 640, 480}; }
};

KeyframeId keyframe(std::uint32_t index) { return {index, 0}; }

// Keyframe k shows the looks 50 k ... 50 k + 199: each shares three quarters with the next.
FeatureSet walk(std::uint32_t k, std::uint64_t noise) {
  return View().show_range(50 * std::uint64_t{k}, 200, noise).set();
}

PlaceIndex walked(std::uint32_t keyframes) {
  PlaceIndex index;
  for (std::uint32_t k = 0; k < keyframes; ++k) index.add(keyframe(k), walk(k, 100 + k));
  return index;
}

std::vector<std::pair<std::uint32_t, int>> listed(const std::vector<PlaceMatch>& matches) {
  std::vector<std::pair<std::uint32_t, int>> out;
  for (const PlaceMatch& m : matches) out.emplace_back(m.keyframe.index, m.votes);
  return out;
}

TEST(PlaceIndex, KnowsNothingWhenEmpty) {
  EXPECT_TRUE(PlaceIndex().query(walk(0, 0), 5).empty());
  EXPECT_TRUE(walked(3).query(FeatureSet(), 5).empty());
}

TEST(PlaceIndex, FindsPlacesSeenWithNoiseAmongHundreds) {
  const PlaceIndex index = walked(300);
  EXPECT_EQ(index.size(), 300);
  for (std::uint32_t k = 0; k < 300; k += 7) {
    const auto matches = index.query(walk(k, 9000 + k), 3);
    ASSERT_FALSE(matches.empty());
    EXPECT_NEAR(matches[0].keyframe.index, k, 1);
    EXPECT_GT(matches[0].votes, 40) << "about a third of 200";
  }
}

TEST(PlaceIndex, ARoomCountsMoreThanAPosterOfIt) {
  // The camera sees sixty looks all over the image; of the poster's thirty-six, one keyframe shows all and nothing else.
  View now, room, poster;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const bool on_poster = i < 36;
    now.show(i);
    now.features.back().u =
        on_poster ? 20.0F + static_cast<float>(i) : 640.0F * static_cast<float>(i - 36) / 24;
    now.features.back().v = on_poster ? 30.0F : 20.0F * static_cast<float>(i - 36);
    if (on_poster) poster.show(i);
    if (!on_poster || i % 4 == 0) room.show(i);
  }
  PlaceIndex index;
  index.add(keyframe(0), poster.set());
  index.add(keyframe(1), room.set());
  const auto matches = index.query(now.set(), 2);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].keyframe, keyframe(1));
  EXPECT_GT(matches[1].votes, matches[0].votes) << "though the poster has more votes";
  EXPECT_LT(2 * matches[1].score, matches[0].score);
}

TEST(PlaceIndex, WhoShowsMuchElseIsLessAlike) {
  // What is asked for all lies on a poster. One keyframe shows the poster, another the poster in a corner of a full view.
  View now, poster, full;
  const auto put = [](View& view, std::uint64_t name, float u, float v) {
    view.show(name);
    view.features.back().u = u;
    view.features.back().v = v;
  };
  for (std::uint64_t i = 0; i < 49; ++i) {
    const auto column = static_cast<float>(i % 7), row = static_cast<float>(i / 7);
    put(now, i, 90 * column, 60 * row);
    put(poster, i, 80 * column, 65 * row);
    put(full, i, 20 * column, 15 * row);
  }
  for (std::uint64_t i = 0; i < 49; ++i)
    put(full, 1000 + i, 90 * static_cast<float>(i % 7), 60 * static_cast<float>(i / 7));
  PlaceIndex index;
  index.add(keyframe(0), full.set());
  index.add(keyframe(1), poster.set());
  const auto matches = index.query(now.set(), 2);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].keyframe, keyframe(1));
  EXPECT_EQ(matches[0].votes, matches[1].votes);
  EXPECT_LT(2 * matches[1].score, matches[0].score);
}

TEST(PlaceIndex, TheNearerTheLookTheMoreItCounts) {
  PlaceIndex index;
  index.add(keyframe(0), View().show_range(0, 60, 1).set());
  index.add(keyframe(1), View().show_range(0, 60).set());
  const auto matches = index.query(View().show_range(0, 60).set(), 2);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].keyframe, keyframe(1));
  const double per_vote = matches[1].score * matches[0].votes / (matches[0].score * matches[1].votes);
  EXPECT_LT(per_vote, 0.95) << "eight bits of 128 off";
  EXPECT_GT(per_vote, 0.5);
}

TEST(PlaceIndex, ScoresUnknownPlacesFarLower) {
  const PlaceIndex index = walked(300);
  const auto known = index.query(walk(120, 9000), 1);
  const auto unknown = index.query(View().show_range(1000000, 200).set(), 1);
  ASSERT_FALSE(known.empty());
  EXPECT_LT(unknown.empty() ? 0.0 : 10 * unknown[0].score, known[0].score);
}

TEST(PlaceIndex, GivesTheBestFirstAndNoMoreThanAsked) {
  const auto matches = walked(40).query(walk(20, 0), 5);
  ASSERT_EQ(matches.size(), 5U);
  for (std::size_t i = 1; i < matches.size(); ++i) EXPECT_GE(matches[i - 1].score, matches[i].score);
}

TEST(PlaceIndex, RemovedKeyframesAreGoneBeforeAndAfterMerges) {
  PlaceIndex index = walked(20);
  index.remove(keyframe(7));
  EXPECT_FALSE(index.contains(keyframe(7)));
  EXPECT_EQ(index.size(), 19);
  for (std::uint32_t k = 20; k < 70; ++k) {
    for (const PlaceMatch& m : index.query(walk(7, 0), 10)) EXPECT_NE(m.keyframe, keyframe(7));
    index.add(keyframe(k), walk(k, 100 + k));
  }
  index.remove(keyframe(7));
  index.add(keyframe(7), walk(7, 0));
  EXPECT_FALSE(index.contains(keyframe(7))) << "an id names one keyframe for ever";
}

TEST(PlaceIndex, RemovalGivesMemoryBack) {
  PlaceIndex index = walked(64);
  const std::size_t full = index.bytes();
  for (std::uint32_t k = 0; k < 64; ++k) index.remove(keyframe(k));
  EXPECT_EQ(index.size(), 0);
  EXPECT_LT(index.bytes(), full / 4);
  EXPECT_TRUE(index.query(walk(5, 0), 5).empty());
}

TEST(PlaceIndex, HistoryLeavesNoTrace) {
  PlaceIndex longer = walked(60), shorter;
  for (std::uint32_t k = 0; k < 60; ++k) {
    if (k % 3 == 0) {
      longer.remove(keyframe(k));
    } else {
      shorter.add(keyframe(k), walk(k, 100 + k));
    }
  }
  const auto a = longer.query(walk(31, 5), 10), b = shorter.query(walk(31, 5), 10);
  EXPECT_EQ(listed(a), listed(b));
  ASSERT_FALSE(a.empty());
  EXPECT_EQ(a[0].score, b[0].score);
}

TEST(PlaceIndex, CopiesStayAsTheyWere) {
  PlaceIndex index = walked(33);
  const PlaceIndex copy = index;
  const auto before = listed(copy.query(walk(10, 5), 5));
  index.remove(keyframe(10));
  for (std::uint32_t k = 33; k < 120; ++k) index.add(keyframe(k), walk(10, k));
  EXPECT_EQ(listed(copy.query(walk(10, 5), 5)), before);
  EXPECT_EQ(copy.size(), 33);
}

TEST(PlaceIndex, LeavesOutTheExcluded) {
  const PlaceIndex index = walked(10);
  std::vector<std::uint8_t> excluded(6, 0);
  excluded[4] = excluded[5] = 1;
  const auto matches = index.query(walk(5, 0), 10, excluded);
  ASSERT_FALSE(matches.empty());
  EXPECT_EQ(matches[0].keyframe, keyframe(6)) << "beyond the end of the flags nothing is excluded";
  for (const PlaceMatch& m : matches) EXPECT_TRUE(m.keyframe.index < 4 || m.keyframe.index > 5);
}

TEST(PlaceIndex, CommonLooksCountLess) {
  PlaceIndex index;
  // All show the same poster of 40 features; keyframe 30 shows 20 that nobody else has, and nothing of the poster.
  for (std::uint32_t k = 0; k < 30; ++k)
    index.add(keyframe(k), View().show_range(0, 40).show_range(1000 + 100 * std::uint64_t{k}, 60).set());
  index.add(keyframe(30), View().show_range(50000, 20).show_range(60000, 80).set());
  const auto matches = index.query(View().show_range(0, 40).show_range(50000, 20).set(), 3);
  ASSERT_FALSE(matches.empty());
  EXPECT_EQ(matches[0].keyframe, keyframe(30));
  EXPECT_EQ(matches[0].votes, 20);
}

TEST(PlaceIndex, FeaturesTurnedAlikeCountTogether) {
  PlaceIndex index;
  View alike, mixed;
  for (std::uint64_t i = 0; i < 60; ++i) {
    alike.show(i, 0, 1.0F);
    mixed.show(i, 0, static_cast<float>(i % 6) - 2.5F);
  }
  index.add(keyframe(0), mixed.set());
  index.add(keyframe(1), alike.set());
  // Turned past the half turn, so that the difference wraps.
  const auto matches = index.query(View().show_range(0, 60, 0, -2.5F).set(), 2);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].keyframe, keyframe(1));
  EXPECT_EQ(matches[0].votes, 60);
  EXPECT_LE(matches[1].votes, 20);
}

TEST(PlaceIndex, KeepsTheStrongestFeaturesAlone) {
  PlaceIndex index(PlaceIndexOptions{50, 25});
  index.add(keyframe(0), View().show_range(0, 100).set());
  const auto matches = index.query(View().show_range(30, 100).set(), 1);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].votes, 20) << "of the query's first 50, 30 to 79, the keyframe's first 50 hold 20";
}

}  // namespace
}  // namespace vsgraphs
