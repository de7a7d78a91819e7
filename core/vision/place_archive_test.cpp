// The place index in an archive.
#include <gtest/gtest.h>

#include "core/base/rng.h"
#include "core/base/test_archive.h"
#include "core/vision/place_index.h"

namespace vsgraphs {
namespace {

constexpr ArchiveKind kind{"TESTPLAC", 1, "index"};

FeatureSet random_features(std::uint64_t name, int count) {
  Rng rng(2, "place_archive_test", name);
  std::vector<Feature> features(static_cast<std::size_t>(count));
  std::vector<Descriptor> descriptors(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    features[i].u = static_cast<float>(rng.index(320));
    features[i].v = static_cast<float>(rng.index(240));
    features[i].angle_rad = static_cast<float>(rng.index(6)) - 3.0F;
    for (auto& word : descriptors[i].words) word = rng.next();
  }
  return {std::move(features), std::move(descriptors), 320, 240};
}

PlaceIndex some_index() {
  PlaceIndex index({100, 20});
  for (std::uint32_t k = 0; k < 25; ++k) {
    if (k != 4) index.add({k, 0}, random_features(k, 120));
  }
  index.remove({3, 0});
  index.remove({20, 0});
  return index;
}

Bytes bytes_of(const PlaceIndex& index) {
  ArchiveWriter archive(kind);
  archive.add("index", index);
  return test::joined(archive.finish());
}

PlaceIndex index_of(const Bytes& bytes) {
  const ArchiveReader archive("FILE", bytes, kind);
  PlaceIndex index;
  archive.read("index", index);
  return index;
}

void expect_same_answers(const PlaceIndex& a, const PlaceIndex& b) {
  EXPECT_EQ(a.size(), b.size());
  EXPECT_EQ(a.keyframes(), b.keyframes());
  for (std::uint64_t k = 0; k < 25; ++k) {
    const auto found = a.query(random_features(k, 120), 3), again = b.query(random_features(k, 120), 3);
    ASSERT_EQ(found.size(), again.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].keyframe, again[i].keyframe);
      EXPECT_EQ(found[i].score, again[i].score);
    }
  }
}

TEST(PlaceArchive, ComesBackWithTheSameAnswersAndBytes) {
  const PlaceIndex index = some_index();
  PlaceIndex back = index_of(bytes_of(index));
  expect_same_answers(index, back);
  EXPECT_EQ(bytes_of(back), bytes_of(index));
  EXPECT_FALSE(back.contains({3, 0}));
  PlaceIndex grown = index;  // and grows alike
  for (std::uint32_t k = 25; k < 45; ++k) {
    grown.add({k, 0}, random_features(k, 120));
    back.add({k, 0}, random_features(k, 120));
  }
  expect_same_answers(grown, back);
  EXPECT_EQ(bytes_of(back), bytes_of(grown));
}

TEST(PlaceArchive, AForgedIndexIsAnErrorOrAnswersQueries) {
  const Bytes whole = bytes_of(some_index());
  const ArchiveReader original("FILE", whole, kind);
  Rng rng(3, "place_archive_test", 1000);
  int errors = 0;
  for (int round = 0; round < 200; ++round) {
    Bytes section(original.section("index").begin(), original.section("index").end());
    for (int i = 0; i < 3; ++i)
      section[rng.index(static_cast<std::uint32_t>(section.size()))] = static_cast<std::byte>(rng.next());
    ArchiveWriter forged(kind);
    forged.add_bytes("index", std::move(section));
    Bytes bytes;
    for (const auto& part : forged.finish()) bytes.insert(bytes.end(), part.begin(), part.end());
    try {
      PlaceIndex index = index_of(bytes);
      index.query(random_features(1, 120), 3);
      index.add({30, 0}, random_features(30, 120));
    } catch (const InputError&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, 20);
}

}  // namespace
}  // namespace vsgraphs
